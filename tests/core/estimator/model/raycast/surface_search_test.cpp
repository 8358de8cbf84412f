#include "core/estimator/model/raycast/surface_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "core/config/groups/frame_config.hpp"
#include "tests/support/fused_scene.hpp"
#include "tests/support/raycast_image.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace tsdf;
using namespace raycast;

namespace {

const PinholeCamera kSearchCamera = test_camera(320, 240, 60.0);
const DepthConfig kDepth;

/// A model of the room, and what the camera at its origin would measure.
struct Room {
  TsdfVolume model =
      fuse(room_with_a_ball(), kSearchCamera, {SE3{}, look_at({0.2, 0.1, -0.3}, {0.3, 0.2, 1.0})});
  RgbdFrame frame = room_with_a_ball().render(kSearchCamera, SE3{}, 75.0);
  std::optional<TsdfLanes> field = field_in_view(model, kSearchCamera, SE3{}, kDepth);

  /// The measured pixels of a rectangle, with an error of depth that `error_m` draws.
  template <class Error>
  std::vector<ExpectedSurface> pixels(int x0, int y0, int side, Error error_m, float reach_m = 0.15F) const {
    std::vector<ExpectedSurface> pixels;
    for (int y = y0; y < y0 + side; ++y) {
      for (int x = x0; x < x0 + side; ++x) {
        const float z = frame.depth_m(x, y);
        if (z <= 0) continue;
        pixels.push_back({static_cast<float>(x), static_cast<float>(y), z + error_m(), reach_m});
      }
    }
    return pixels;
  }

  /// Results of each search method.
  [[nodiscard]] std::vector<SurfacePoint> found_beside(const std::vector<ExpectedSurface>& pixels) const {
    TsdfBrick brick;
    std::vector<SurfacePoint> surfaces(pixels.size());
    SurfaceSearch(*field, kSearchCamera, SE3{}, kDepth).find_near_measurements(pixels, brick, surfaces);
    return surfaces;
  }
  [[nodiscard]] std::vector<SurfacePoint> found(const std::vector<ExpectedSurface>& pixels) const {
    std::vector<SurfacePoint> surfaces(pixels.size());
    SurfaceSearch(*field, kSearchCamera, SE3{}, kDepth).find(pixels, surfaces);
    return surfaces;
  }
  [[nodiscard]] std::vector<SurfacePoint> walked(const std::vector<ExpectedSurface>& pixels) const {
    std::vector<PixelRay> rays;
    for (const ExpectedSurface& pixel : pixels) {
      rays.push_back({static_cast<double>(pixel.u_px), static_cast<double>(pixel.v_px)});
    }
    std::vector<SurfacePoint> surfaces;
    testing::raycast_pixels(model, kSearchCamera, SE3{}, rays, kDepth, Workers(1), surfaces);
    return surfaces;
  }
};

/// Share of the surfaces of the ray march that the search finds, and their largest difference.
struct Agreement {
  double share = 0;
  double depth_m = 0;
  double normal_deg = 0;
};
Agreement compare(const std::vector<SurfacePoint>& found, const std::vector<SurfacePoint>& walked) {
  Agreement agreement;
  int hits = 0;
  int both = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    hits += walked[i].valid ? 1 : 0;
    if (!walked[i].valid || !found[i].valid) continue;
    ++both;
    agreement.depth_m = std::max(agreement.depth_m, std::abs(found[i].depth_m - walked[i].depth_m));
    const double cosine = std::min(1.0, found[i].normal_world.dot(walked[i].normal_world));
    agreement.normal_deg = std::max(agreement.normal_deg, degrees(std::acos(cosine)));
  }
  agreement.share = static_cast<double>(both) / hits;
  return agreement;
}

float exact() { return 0.0F; }

TEST(SurfaceSearch, FindsWhatWalkingTheRayFindsInSpiteOfNoise) {
  const Room room;
  std::mt19937 random(7);
  std::normal_distribution<float> noise_m(0.0F, 0.004F);
  const auto pixels = room.pixels(60, 60, 40, [&] { return noise_m(random); });
  ASSERT_GT(pixels.size(), 1500U);
  const auto beside = room.found_beside(pixels);
  const auto found = room.found(pixels);
  const auto walked = room.walked(pixels);
  for (const auto& surfaces : {beside, found}) {
    const Agreement agreement = compare(surfaces, walked);
    EXPECT_GT(agreement.share, 0.99);
    EXPECT_LT(agreement.depth_m, 0.05 * room.model.voxel_m());
    EXPECT_LT(agreement.normal_deg, 1.0);
  }
}

TEST(SurfaceSearch, BothWaysGiveOneResult) {
  const Room room;
  const auto pixels = room.pixels(100, 80, 10, exact);
  const auto beside = room.found_beside(pixels);
  const auto found = room.found(pixels);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    ASSERT_TRUE(beside[i].valid && found[i].valid);
    EXPECT_NEAR(beside[i].depth_m, found[i].depth_m, 1e-5);
    EXPECT_GT(beside[i].normal_world.dot(found[i].normal_world), 1 - 1e-5);
  }
}

TEST(SurfaceSearch, NearAndFarPartsOfAnEdgeAreBothFound) {
  // The ball before the wall: more than a brick holds at once.
  const Room room;
  const auto pixels = room.pixels(160, 100, 120, exact);
  EXPECT_GT(compare(room.found_beside(pixels), room.walked(pixels)).share, 0.9);
}

TEST(SurfaceSearch, IgnoresASurfaceOutOfReach) {
  const Room room;
  for (const float error_m : {-0.03F, 0.03F}) {
    for (const float reach_m : {0.02F, 0.05F}) {
      const auto pixels = room.pixels(
          60, 60, 10, [&] { return error_m; }, reach_m);
      for (const SurfacePoint& surface : room.found(pixels))
        EXPECT_EQ(surface.valid, reach_m > std::abs(error_m));
    }
  }
}

}  // namespace
}  // namespace fusebench
