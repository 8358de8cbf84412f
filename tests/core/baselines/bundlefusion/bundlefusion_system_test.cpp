#include "core/baselines/bundlefusion/bundlefusion_system.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/systems_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "tests/support/simulated_frames.hpp"

namespace fusebench {

using namespace baselines::bundlefusion;
using health::FrameStatus;

namespace {

/// The images of the tests are of half the size that the option's default is for.
config::BundlefusionConfig test_config() {
  config::BundlefusionConfig config;
  config.min_keypoint_scale_px = 1.5;
  return config;
}

View view_of(const RgbdFrame& frame, const PinholeCamera& camera) {
  return {find_keypoints(frame.grey, frame.depth_m, camera, 1024, 1.5),
          make_depth_cloud(frame.depth_m, camera)};
}

struct SystemRun {
  std::vector<health::FrameOutcome> outcomes;
  std::optional<Trajectory> revised;
  std::size_t model_blocks = 0;
};

SystemRun run_system(const testing::SimulatedRun& recording, int threads) {
  const Workers workers(threads);
  BundlefusionSystem system(test_config(), {}, {}, recording.rig, workers,
                            testing::replay_of(recording.frames));
  SystemRun run;
  for (const RgbdFrame& frame : recording.frames) {
    auto outcome = system.process(frame);
    EXPECT_TRUE(outcome.has_value());
    run.outcomes.push_back(std::move(*outcome));
  }
  run.revised = *system.revise();
  run.model_blocks = std::get<tsdf::TsdfVolume>(system.take_surface()).block_count();
  return run;
}

TEST(BundlefusionKeypoints, LieOnTheMarkWithItsDepth) {
  PinholeCamera camera{320, 240, 240.0, 240.0, 159.5, 119.5};
  GreyImage grey(camera.width_px, camera.height_px, 60);
  const Vector2d mark_px(140, 100);
  for (int y = 0; y < grey.height; ++y) {
    for (int x = 0; x < grey.width; ++x) {
      const double squared_px = (Vector2d(x, y) - mark_px).squaredNorm();
      grey(x, y) = static_cast<std::uint8_t>(std::lround(60 + 150 * std::exp(-squared_px / (2 * 16.0))));
    }
  }
  const DepthImage depth_m(camera.width_px, camera.height_px, 1.5F);
  const Keypoints keypoints = find_keypoints(grey, depth_m, camera, 1024, 3.0);
  ASSERT_FALSE(keypoints.empty());
  EXPECT_LT((keypoints.front().pixel_px - mark_px).norm(), 0.1);
  EXPECT_LT((keypoints.front().point_camera - camera.back_project(140, 100, 1.5)).norm(), 0.001);
  EXPECT_TRUE(find_keypoints(grey, depth_m, camera, 1024, 20.0).empty());
  EXPECT_TRUE(find_keypoints(grey, DepthImage(320, 240), camera, 1024, 3.0).empty());
}

TEST(BundlefusionChunk, RecoversTheMotionOfItsFrames) {
  const testing::SimulatedRun run = testing::simulate(11, {}, {0.3, 0.5, -0.4});
  const Workers workers(2);
  Chunk chunk(view_of(run.frames[0], run.rig.camera), {}, workers);
  for (std::size_t k = 1; k < run.frames.size(); ++k)
    EXPECT_TRUE(chunk.add(view_of(run.frames[k], run.rig.camera))) << k;
  ASSERT_TRUE(chunk.close());
  EXPECT_EQ(chunk.last_placed(), 10U);
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    const SE3 error = run.T_first_camera[k].inverse() * *chunk.T_first_camera()[k];
    EXPECT_LT(error.translation.norm(), 0.005) << k;
    EXPECT_LT(rotation_angle_rad(error.rotation, Quaterniond::Identity()), 0.005) << k;
  }
  const View merged = chunk.merged(run.rig.camera);
  EXPECT_GT(merged.keypoints.size(), 20U);
  EXPECT_LT(merged.keypoints.size(), 1024U);
}

TEST(BundlefusionSystem, PlacesAllFramesAndFusesThemAtTheEnd) {
  const testing::SimulatedRun recording = testing::simulate(26, {}, {0.15, 0.3, -0.2});
  const SystemRun run = run_system(recording, 2);
  for (std::size_t k = 0; k < run.outcomes.size(); ++k) {
    const health::FrameOutcome& outcome = run.outcomes[k];
    EXPECT_EQ(outcome.status, k == 0 ? FrameStatus::initialised : FrameStatus::tracked)
        << k << ": " << outcome.reason;
    EXPECT_LT((outcome.T_world_camera.translation - recording.T_first_camera[k].translation).norm(), 0.02);
  }
  ASSERT_TRUE(run.revised.has_value());
  ASSERT_EQ(run.revised->size(), recording.frames.size());
  for (std::size_t k = 0; k < run.revised->size(); ++k) {
    EXPECT_EQ((*run.revised)[k].timestamp_ns, recording.frames[k].timestamp_ns);
    const SE3& T_world_camera = (*run.revised)[k].T_world_camera;
    EXPECT_LT((T_world_camera.translation - recording.T_first_camera[k].translation).norm(), 0.01) << k;
  }
  EXPECT_GT(run.model_blocks, 0U);
}

TEST(BundlefusionSystem, GivesTheSameBytesWithAnyNumberOfThreads) {
  const testing::SimulatedRun recording = testing::simulate(14);
  const SystemRun one = run_system(recording, 1);
  const SystemRun four = run_system(recording, 4);
  for (std::size_t k = 0; k < one.outcomes.size(); ++k) {
    const SE3 &a = one.outcomes[k].T_world_camera, &b = four.outcomes[k].T_world_camera;
    EXPECT_EQ(a.translation, b.translation) << k;
    EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs()) << k;
  }
  ASSERT_TRUE(one.revised && four.revised);
  ASSERT_EQ(one.revised->size(), four.revised->size());
  for (std::size_t k = 0; k < one.revised->size(); ++k) {
    const SE3 &a = (*one.revised)[k].T_world_camera, &b = (*four.revised)[k].T_world_camera;
    EXPECT_EQ(a.translation, b.translation) << k;
    EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs()) << k;
  }
  EXPECT_EQ(one.model_blocks, four.model_blocks);
}

TEST(BundlefusionSystem, LosesFramesWithoutKeypointsAndReportsTheReason) {
  testing::SimulatedRun recording = testing::simulate(16, {}, {0.15, 0.3, -0.2});
  std::ranges::fill(recording.frames[4].grey.data, std::uint8_t{90});
  std::ranges::fill(recording.frames[6].depth_m.data, 0.0F);
  std::ranges::reverse(recording.frames[8].grey.data);  // keypoints, but not those of any other frame
  const SystemRun run = run_system(recording, 2);
  for (const std::size_t k : {std::size_t{4}, std::size_t{6}, std::size_t{8}}) {
    EXPECT_EQ(run.outcomes[k].status, FrameStatus::lost) << k;
    EXPECT_FALSE(run.outcomes[k].reason.empty()) << k;
    EXPECT_EQ(run.outcomes[k + 1].status, FrameStatus::relocalised) << k;
  }
  EXPECT_EQ(run.outcomes[4].reason, "only 0 keypoints with depth");
  EXPECT_EQ(run.outcomes[8].reason, "the frame matches no frame of its chunk");
  EXPECT_EQ(run.outcomes[11].status, FrameStatus::tracked);
  ASSERT_TRUE(run.revised.has_value());
  EXPECT_EQ(run.revised->size(), recording.frames.size() - 3);
}

TEST(BundlefusionSystem, WaitsForAFirstFrameWithKeypoints) {
  testing::SimulatedRun recording = testing::simulate(4, {}, {0.15, 0.3, -0.2});
  std::ranges::fill(recording.frames[0].grey.data, std::uint8_t{90});
  const SystemRun run = run_system(recording, 1);
  EXPECT_EQ(run.outcomes[0].status, FrameStatus::lost);
  EXPECT_FALSE(run.outcomes[0].reason.empty());
  EXPECT_EQ(run.outcomes[1].status, FrameStatus::initialised);
  EXPECT_EQ(run.outcomes[2].status, FrameStatus::tracked);
}

}  // namespace
}  // namespace fusebench
