#include "eval/record/pose_intensity/pose_intensity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "eval/record/pose_intensity/probes.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace pose_intensity;

namespace {

constexpr std::int64_t kFrame_ns = 33'000'000;

SE3 pose_at(std::size_t frame) {
  const auto k = static_cast<double>(frame);
  return {so3_exp({0.004 * k, -0.01 * k, 0.003 * k}), {0.01 * k, 0.004 * k, -0.006 * k}};
}

/// Frames of the room along a path, with the path as ground truth.
recording::Recording recorded_room(std::size_t frames) {
  recording::Recording recording;
  recording.name = "room";
  recording.rig.camera = testing::small_camera();
  for (std::size_t k = 0; k < frames; ++k) {
    const std::int64_t at_ns = static_cast<std::int64_t>(k) * kFrame_ns;
    recording.frames.push_back({at_ns, at_ns, at_ns, at_ns, {}, {}});
    recording.ground_truth.push_back({at_ns, pose_at(k)});
  }
  recording.load_frame = [](std::size_t frame) -> Result<RgbdFrame> {
    return testing::TexturedRoom{}.render(testing::small_camera(), pose_at(frame), 0);
  };
  return recording;
}

/// The true poses, seen from another world, each turned by an error about y that alternates.
Trajectory path(std::size_t frames, double error_rad) {
  const SE3 T_other_world{so3_exp({0.3, -1.0, 2.0}), {5, 6, 7}};
  Trajectory poses;
  for (std::size_t k = 0; k < frames; ++k) {
    const SE3 error{so3_exp({0, k % 2 == 0 ? error_rad : -error_rad, 0}), {0, 0, 0}};
    poses.push_back({static_cast<std::int64_t>(k) * kFrame_ns, T_other_world * pose_at(k) * error});
  }
  return poses;
}

TEST(PoseIntensity, TruePosesHaveTheLeastErrorAndItGrowsWithTheirs) {
  const recording::Recording recording = recorded_room(5);
  const std::vector<NamedTrajectory> trajectories = {
      {"true", path(5, 0)}, {"off by 0.2 px", path(5, 0.0004)}, {"off by 5 px", path(5, 0.01)}};
  const auto result = pose_intensity::pose_intensity(recording, trajectories, {});
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_EQ(result->frames, 4U);
  EXPECT_GT(result->pixels, 4U * 1000);
  EXPECT_TRUE(result->visibility_by_truth);
  EXPECT_LT(result->trajectories[0].aie_grey, 1.5) << "interpolation of an image without noise";
  EXPECT_GT(result->trajectories[1].aie_grey, result->trajectories[0].aie_grey);
  EXPECT_GT(result->trajectories[2].aie_grey, 3 * result->trajectories[1].aie_grey);
  EXPECT_GE(result->trajectories[0].rms_grey, result->trajectories[0].aie_grey);
}

TEST(PoseIntensity, OnlyPairsOfWhichAllHaveBothPosesCount) {
  const recording::Recording recording = recorded_room(6);
  Trajectory gap = path(6, 0);
  gap.erase(gap.begin() + 2);
  const std::vector<NamedTrajectory> both = {{"whole", path(6, 0.001)}, {"gap", gap}};
  const auto result = pose_intensity::pose_intensity(recording, both, {});
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->possible, 5U);
  EXPECT_EQ(result->frames, 3U) << "not 1-2 and 2-3";
  EXPECT_EQ(result->trajectories[0].frames, 6U);
  EXPECT_EQ(result->trajectories[1].frames, 5U);
  const std::vector<NamedTrajectory> alone = {{"one pose", {path(6, 0).front()}}};
  const auto none = pose_intensity::pose_intensity(recording, alone, {});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::data_missing);
}

TEST(PoseIntensity, APoseThatLosesPixelsDoesNotGainByIt) {
  const recording::Recording recording = recorded_room(3);
  const std::vector<NamedTrajectory> wild = {{"true", path(3, 0)}, {"turned away", path(3, 1.5)}};
  const auto result = pose_intensity::pose_intensity(recording, wild, {});
  ASSERT_TRUE(result.has_value());
  EXPECT_TRUE(std::isfinite(result->trajectories[1].aie_grey));
  EXPECT_GT(result->trajectories[1].aie_grey, 10 * result->trajectories[0].aie_grey);
}

TEST(PoseIntensity, TrueDepthNeedsATrueSurface) {
  const recording::Recording recording = recorded_room(3);
  ProbeOptions options;
  options.true_depth = true;
  const auto result =
      pose_intensity::pose_intensity(recording, std::vector<NamedTrajectory>{{"true", path(3, 0)}}, options);
  ASSERT_FALSE(result.has_value());
  testing::expect_contains(result.error().message, "ground-truth mesh");
}

TEST(PoseIntensity, TrueDepthIsThatOfThePlaneAlongTheAxis) {
  // A wall at z = 2 of the truth's world, seen from z = 0.5, turned by 0.2 rad about y.
  Mesh wall;
  wall.vertices = {{-50, -50, 2}, {50, -50, 2}, {50, 50, 2}, {-50, 50, 2}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  const PinholeCamera camera = testing::small_camera();
  const SE3 T_truth_camera{so3_exp({0, 0.2, 0}), {0, 0, 0.5}};
  const DepthImage depth_m = true_depth_m(simulator::rays::RayCaster(wall), camera, T_truth_camera);
  for (const auto& [x, y] : {std::pair{0, 0}, std::pair{160, 120}, std::pair{319, 200}}) {
    const Vector3d ray = T_truth_camera.rotation * camera.back_project(x, y, 1.0);
    EXPECT_NEAR(static_cast<double>(depth_m(x, y)), 1.5 / ray.z(), 1e-4) << x << ' ' << y;
  }
}

}  // namespace
}  // namespace fusebench
