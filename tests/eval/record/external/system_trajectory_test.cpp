#include "eval/record/external/system_trajectory.hpp"

#include <gtest/gtest.h>

#include <string>

#include "datasets/recording/image_logs/sens_log.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using external::read_system_trajectory;
using testing::expect_contains;

namespace {

/// Frames at 1, 2 and 3 s; the truth moves by 1 m a second along x.
class SystemTrajectoryFile : public testing::InTemporaryFolder {
 protected:
  SystemTrajectoryFile() {
    for (int second = 1; second <= 3; ++second) {
      recording::FrameEntry frame;
      frame.timestamp_ns = second * 1'000'000'000LL;
      recording_.frames.push_back(frame);
      recording_.ground_truth.push_back(
          {frame.timestamp_ns, {Quaterniond::Identity(), {static_cast<double>(second), 0, 0}}});
    }
  }

  Result<external::FramePoses> read(const std::string& name, const std::string& bytes,
                                    external::SystemTrajectory trajectory = {}) {
    trajectory.file = write(name, bytes);
    warnings_.clear();
    return read_system_trajectory(trajectory, recording_, warnings_);
  }

  recording::Recording recording_;
  std::vector<std::string> warnings_;
};

std::string along_x(double step) {
  std::string text;
  for (int second = 1; second <= 3; ++second)
    text += std::to_string(second) + " " + std::to_string(second * step) + " 0 0 0 0 0 1\n";
  return text;
}

std::string sens_with_a_pose() {
  image_logs::SensHeader header{"made", {2, 1, 500, 500, 0.5, 0}, {2, 1, 500, 500, 0.5, 0}};
  header.frames = 1;
  image_logs::SensFrame frame;
  frame.T_world_camera = SE3{Quaterniond::Identity(), {0.25, 1, -2}};
  frame.color_timestamp_us = 2'000'000;
  frame.color = "a JPEG";
  frame.depth = Image<std::uint16_t>(2, 1, 1234);
  return image_logs::sens_bytes(header) + image_logs::sens_bytes(frame) + std::string(8, '\0');
}

TEST_F(SystemTrajectoryFile, PosesOfASensFileAreKnownByItsName) {
  const auto frames = read("room.sens", sens_with_a_pose());
  ASSERT_TRUE(frames.has_value()) << frames.error().message;
  ASSERT_EQ(frames->poses.size(), 1);
  EXPECT_EQ(frames->poses[0].timestamp_ns, 2'000'000'000);
  EXPECT_EQ(frames->poses[0].T_world_camera.translation, Vector3d(0.25, 1, -2));
  EXPECT_EQ(read("poses.txt", sens_with_a_pose()).error().code, ErrorCode::data_corrupt);
}

TEST_F(SystemTrajectoryFile, AFormatThatIsSaidCountsMoreThanTheName) {
  external::SystemTrajectory tum;
  tum.format = trajectory_files::TrajectoryFormat::tum;
  const auto frames = read("room.sens", along_x(1), tum);
  ASSERT_TRUE(frames.has_value()) << frames.error().message;
  EXPECT_EQ(frames->poses.size(), 3);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(SystemTrajectoryFile, MillimetresAndInversePosesBecomeMetresInTheWorld) {
  external::SystemTrajectory trajectory;
  trajectory.unit_m = 1e-3;
  trajectory.world_to_camera = true;
  const auto frames = read("poses.txt", along_x(-1000), trajectory);
  ASSERT_TRUE(frames.has_value()) << frames.error().message;
  EXPECT_NEAR((frames->poses[2].T_world_camera.translation - Vector3d(3, 0, 0)).norm(), 0, 1e-12);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(SystemTrajectoryFile, AUnitThatCannotBeIsRefusedAndOneThatMayBeIsAWarning) {
  const auto large = read("poses.txt", along_x(1000));
  ASSERT_FALSE(large.has_value());
  expect_contains(large.error().message, "over 2e+03 m, and the ground truth over 2 m");
  const auto small = read("poses.txt", along_x(1e-3));
  ASSERT_TRUE(small.has_value());
  ASSERT_EQ(warnings_.size(), 1);
  expect_contains(warnings_[0], "is the unit of the trajectory right");
}

}  // namespace
}  // namespace fusebench
