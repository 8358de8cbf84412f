#include "core/baselines/infinitam/fern_relocaliser.hpp"

#include <gtest/gtest.h>

#include "core/config/config.hpp"
#include "tests/support/analytic_scene.hpp"
#include "tests/support/fused_scene.hpp"
#include "tests/support/tracked_system.hpp"

namespace fusebench {

using namespace baselines::infinitam;
using testing::small_camera;

namespace {

SE3 turned(double yaw_rad) { return {so3_exp({0, yaw_rad, 0}), Vector3d::Zero()}; }

TEST(FernRelocaliser, RecognisesAFrameAndStoresNoneTwice) {
  const PinholeCamera camera = small_camera();
  const AnalyticScene scene = room_with_a_ball();
  FernRelocaliser relocaliser(camera, {}, config::PeerDefects::fixed);
  const auto code_at = [&](double yaw_rad) {
    return relocaliser.code_of(scene.render(camera, turned(yaw_rad)).depth_m);
  };
  EXPECT_EQ(relocaliser.most_similar(code_at(0)), nullptr);
  for (const double yaw_rad : {0.0, 1.0, 2.0})
    EXPECT_TRUE(relocaliser.offer(code_at(yaw_rad), turned(yaw_rad)));
  EXPECT_FALSE(relocaliser.offer(code_at(1.0), turned(1.0)));
  EXPECT_EQ(relocaliser.size(), 3U);
  const SE3* const found = relocaliser.most_similar(code_at(1.03));
  ASSERT_NE(found, nullptr);
  EXPECT_LT(rotation_angle_rad(found->rotation, turned(1.0).rotation), 1e-9);
  EXPECT_EQ(ferns::dissimilarity(code_at(1.0), code_at(1.0)), 0);
  EXPECT_GT(ferns::dissimilarity(code_at(0), code_at(1.0)), 0.2);
}

TEST(FernRelocaliser, AsPublishedSeesTheTopLeftQuarterAlone) {
  PinholeCamera camera;
  camera.width_px = 640;
  camera.height_px = 480;
  DepthImage image(camera.width_px, camera.height_px, 1.5F);
  DepthImage changed = image;
  for (int y = camera.height_px * 3 / 4; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) changed(x, y) = 0.4F;
  }
  const FernRelocaliser published(camera, {}, config::PeerDefects::as_published);
  const FernRelocaliser fixed(camera, {}, config::PeerDefects::fixed);
  EXPECT_EQ(ferns::dissimilarity(published.code_of(image), published.code_of(changed)), 0);
  EXPECT_GT(ferns::dissimilarity(fixed.code_of(image), fixed.code_of(changed)), 0.1);
}

TEST(FernRelocaliser, FindsThePlaceAgainAfterAJump) {
  testing::SimulatedRun run = testing::simulate(24, {}, {0.1, 0.2, -0.1});
  // The camera is covered by something near, then back at an earlier place.
  for (std::size_t k = 14; k < 17; ++k) std::ranges::fill(run.frames[k].depth_m.data, 0.25F);
  for (std::size_t k = 17; k < 24; ++k) {
    const std::int64_t stamp_ns = run.frames[k].timestamp_ns;
    run.frames[k] = run.frames[2];
    run.frames[k].timestamp_ns = stamp_ns;
    run.T_first_camera[k] = run.T_first_camera[2];
  }
  config::Config config = testing::config_of_variant("infinitam");
  config.infinitam.on_failure = config::InfinitamFailure::relocalise;
  const auto tracked = testing::track_with(config, run);
  EXPECT_EQ(tracked.outcomes[15].status, health::FrameStatus::lost);
  const auto& last = tracked.outcomes.back();
  EXPECT_NE(last.status, health::FrameStatus::lost) << last.reason;
  EXPECT_LT((last.T_world_camera.translation - run.T_first_camera.back().translation).norm(), 0.02);
}

}  // namespace
}  // namespace fusebench
