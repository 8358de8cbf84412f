#include "core/baselines/elasticfusion/surfels/surfel_fusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/systems_config.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace baselines::elasticfusion::surfels;

namespace {

const PinholeCamera kWallCamera = {80, 60, 60, 60, 39.5, 29.5};

/// A wall across the view.
LiveFrame wall_at(float depth_m, const Workers& workers) {
  RgbdFrame frame;
  frame.depth_m = DepthImage(kWallCamera.width_px, kWallCamera.height_px, depth_m);
  frame.color = ColorImage(kWallCamera.width_px, kWallCamera.height_px, {10, 20, 30});
  return make_live_frame(frame, kWallCamera, {}, config::PeerDefects::fixed, workers);
}

class Fusion : public ::testing::Test {
 protected:
  void fuse(float depth_m, int frames, double aside_m = 0) {
    const LiveFrame live = wall_at(depth_m, workers);
    const SE3 T_world_camera{Quaterniond::Identity(), {aside_m, aside_m, 0}};
    for (int i = 0; i < frames; ++i) {
      if (now == 0)
        fusion.start(live, {T_world_camera, now, 1}, map);
      else
        fusion.fuse(live, {T_world_camera, now, 1}, map);
      ++now;
    }
  }
  [[nodiscard]] long stable() const {
    return std::ranges::count_if(map.confidence, [](float confidence) { return confidence > 10; });
  }

  Workers workers{2};
  SurfelFusion fusion{kWallCamera, 10, 200, workers};
  SurfelMap map;
  std::int32_t now = 0;
};

TEST_F(Fusion, StartsWithASurfelForEachPixelThatHasANormal) {
  fuse(2, 1);
  EXPECT_EQ(map.size(), static_cast<std::size_t>((kWallCamera.width_px - 2) * (kWallCamera.height_px - 2)));
  for (std::size_t i = 0; i < map.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(map.position[i].z()), 2, 1e-5);
    EXPECT_NEAR(static_cast<double>(map.normal[i].z()), -1, 1e-5);
  }
}

TEST_F(Fusion, TheSameWallAgainAddsNothingAndBecomesStable) {
  fuse(2, 1);
  const std::size_t first = map.size();
  fuse(2, 30);
  EXPECT_LE(map.size(), first);
  EXPECT_GT(stable(), 500);
  for (std::size_t i = 0; i < map.size(); ++i) EXPECT_NEAR(static_cast<double>(map.position[i].z()), 2, 1e-4);
}

TEST_F(Fusion, UnstableSurfelsDieWhenTheyAreNotSeenForTwentyFrames) {
  fuse(2, 2);
  const auto old = [&] { return std::ranges::count_if(map.created, [](auto time) { return time < 2; }); };
  EXPECT_GT(old(), 1000);
  fuse(1, 19);
  EXPECT_GT(old(), 1000);
  fuse(1, 3);
  EXPECT_EQ(old(), 0);
}

TEST_F(Fusion, AWallFurtherAwayEndsWhatWasInFrontOfIt) {
  fuse(2, 40);
  const auto near = [&] {
    return std::ranges::count_if(map.position, [](const auto& position) { return position.z() < 2.1F; });
  };
  EXPECT_GT(stable(), 500);
  EXPECT_GT(near(), 1000);
  // A hand-held camera sways, so that the surfels of both walls are on other rays in each frame.
  for (int i = 0; i < 80; ++i) fuse(2.5F, 1, 0.05 * std::sin(0.4 * i));
  EXPECT_LT(near(), 50);
  EXPECT_GT(stable(), 500);
}

TEST_F(Fusion, IsTheSameForAnyNumberOfThreads) {
  fuse(2, 4);
  fuse(2.02F, 4);
  const Workers one(1);
  SurfelFusion alone(kWallCamera, 10, 200, one);
  SurfelMap other;
  for (std::int32_t time = 0; time < 8; ++time) {
    const LiveFrame live = wall_at(time < 4 ? 2.0F : 2.02F, one);
    if (time == 0)
      alone.start(live, {SE3{}, time, 1}, other);
    else
      alone.fuse(live, {SE3{}, time, 1}, other);
  }
  EXPECT_EQ(map.position, other.position);
  EXPECT_EQ(map.confidence, other.confidence);
  EXPECT_EQ(map.updated, other.updated);
}

}  // namespace
}  // namespace fusebench
