#include "eval/external/system_trajectory.hpp"

#include <gtest/gtest.h>

#include <string>

#include "datasets/exports/sens_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using external::load_system_trajectory;

namespace {

using SystemTrajectory = testing::InTemporaryFolder;

std::string sens_with_a_pose() {
  exports::SensHeader header{"made", {2, 1, 500, 500, 0.5, 0}, {2, 1, 500, 500, 0.5, 0}};
  header.frames = 1;
  exports::SensFrame frame;
  frame.T_world_camera = SE3{Quaterniond::Identity(), {0.25, 1, -2}};
  frame.color_timestamp_us = 5000;
  frame.color = "a JPEG";
  frame.depth = Image<std::uint16_t>(2, 1, 1234);
  return exports::sens_bytes(header) + exports::sens_bytes(frame) + std::string(8, '\0');
}

TEST_F(SystemTrajectory, PosesOfASensFileAreKnownByItsName) {
  std::vector<std::string> warnings;
  const auto loaded = load_system_trajectory(write("room.sens", sens_with_a_pose()), {}, warnings);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().message;
  EXPECT_TRUE(loaded->has_stamps());
  ASSERT_EQ(loaded->poses.size(), 1);
  EXPECT_EQ(loaded->poses[0].timestamp_ns, 5'000'000);
  EXPECT_EQ(loaded->poses[0].T_world_camera.translation, Vector3d(0.25, 1, -2));
}

TEST_F(SystemTrajectory, AFormatThatIsSaidCountsMoreThanTheName) {
  std::vector<std::string> warnings;
  const auto tum = load_system_trajectory(write("room.sens", "1 0 0 0 0 0 0 1\n"),
                                          trajectory_files::TrajectoryFormat::tum, warnings);
  ASSERT_TRUE(tum.has_value()) << tum.error().message;
  EXPECT_EQ(tum->poses.size(), 1);
  EXPECT_EQ(load_system_trajectory(write("poses.txt", sens_with_a_pose()), {}, warnings).error().code,
            ErrorCode::data_corrupt);
}

}  // namespace
}  // namespace fusebench
