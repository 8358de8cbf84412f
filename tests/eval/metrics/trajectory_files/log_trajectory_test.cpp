#include "eval/metrics/trajectory_files/log_trajectory.hpp"

#include <gtest/gtest.h>

#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace trajectory_files;

namespace {

const std::string kPose = "0 -1 0 0.5\n1 0 0 0.25\n0 0 1 2\n0 0 0 1\n";

class LogTrajectory : public testing::InTemporaryFolder {
 protected:
  std::string refused(const std::string& text) {
    std::vector<std::string> warnings;
    const auto poses = read_log_trajectory(write("t.log", text), warnings);
    return poses ? "accepted" : poses.error().message;
  }
};

TEST_F(LogTrajectory, ReadsPosesByTheNumberOfTheirFrame) {
  std::vector<std::string> warnings;
  const auto file = write("t.log", "0 0 1\n" + kPose + "4 4 5\n" + kPose);
  const auto loaded = load_trajectory(file, {{}, {}, trajectory::Duplicates::error}, warnings);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().message;
  EXPECT_EQ(loaded->format, TrajectoryFormat::log) << "recognised by its first row";
  EXPECT_TRUE(loaded->has_numbers());
  EXPECT_FALSE(loaded->has_stamps());
  ASSERT_EQ(loaded->poses.size(), 2U);
  EXPECT_EQ(loaded->poses[1].timestamp_ns, 4);
  EXPECT_TRUE(loaded->poses[1].T_world_camera.translation.isApprox(Vector3d(0.5, 0.25, 2)));
  // A quarter turn about z takes x to y.
  EXPECT_TRUE((loaded->poses[1].T_world_camera.rotation * Vector3d::UnitX()).isApprox(Vector3d::UnitY()));
  EXPECT_TRUE(warnings.empty());
}

TEST_F(LogTrajectory, LeavesOutLostFrames) {
  std::vector<std::string> warnings;
  const auto poses = read_log_trajectory(
      write("t.log", "0 0 1\n" + kPose +
                         "1 1 2\nnan nan nan nan\nnan nan nan nan\nnan nan nan nan\n0 0 0 1\n2 2 3\n" +
                         kPose),
      warnings);
  ASSERT_TRUE(poses.has_value()) << poses.error().message;
  ASSERT_EQ(poses->size(), 2U);
  EXPECT_EQ((*poses)[1].timestamp_ns, 2);
  ASSERT_EQ(warnings.size(), 1U);
  testing::expect_contains(warnings[0], "t.log:10: 1 of 3 poses are of lost frames");
}

TEST_F(LogTrajectory, RefusesByLine) {
  testing::expect_contains(refused("0 0 1\n0 -1 0 0.5\n1 0 0 0.25\n"),
                           "t.log:3: the file ends within a pose");
  testing::expect_contains(refused(kPose), "t.log:1: four numbers");
  testing::expect_contains(refused("0 0 1\n" + kPose + "0 0 1\n" + kPose), "t.log:6: frame 0 after frame 0");
  testing::expect_contains(refused("0 0 1\n0 1 0 0\n1 0 0 0\n0 0 1 0\n0 0 0 1\n"),
                           "is no rotation (determinant -1");
  testing::expect_contains(refused("0 0 1\n0 -1 0 x\n1 0 0 0\n0 0 1 0\n0 0 0 1\n"), "t.log:2");
  testing::expect_contains(refused("0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n"),
                           "t.log:5: the last row of the pose is 0 0 0 2");
  testing::expect_contains(refused("0.5 0 1\n" + kPose), "an integer from 0 on");
  testing::expect_contains(refused("1e300 0 1\n" + kPose), "an integer from 0 on");
  testing::expect_contains(refused("# nothing\n"), "has no rows");
}

}  // namespace
}  // namespace fusebench
