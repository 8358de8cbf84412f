#include "core/estimator/patches/patch_surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "tests/support/fused_scene.hpp"
#include "tests/support/raycast_image.hpp"

namespace fusebench {

using namespace config;
using namespace tsdf;
using namespace raycast;
using namespace patches;

namespace {

const PinholeCamera kCamera = test_camera(320, 240, 60.0);
const DepthConfig kDepth;

TsdfVolume fused_room() { return fuse(room_with_a_ball(), kCamera, {SE3{}}); }

/// Up to twenty patches of a frame of the room, with holes in the depth and with errors too large for the
/// local search.
struct Cut {
  TsdfVolume model = fused_room();
  std::vector<ExpectedSurface> pixels;
  std::vector<std::size_t> first{0};

  explicit Cut(int patches = 20, int shift_px = 0) {
    const RgbdFrame frame = room_with_a_ball().render(kCamera, SE3{}, 75.0);
    for (int patch = 0; patch < patches; ++patch) {
      const int x0 = 30 + 50 * (patch % 5) + shift_px;
      const int y0 = 30 + 50 * (patch / 5);
      for (int y = y0; y < y0 + 10; ++y) {
        for (int x = x0; x < x0 + 10; ++x) add(frame, x, y);
      }
      first.push_back(pixels.size());
    }
  }

  void add(const RgbdFrame& frame, int x, int y) {
    const bool hole = x % 10 == 3;
    const float error_m = y % 10 == 7 ? 0.06F : 0.0F;
    const float measured_m = hole ? 0.0F : frame.depth_m(x, y) + error_m;
    pixels.push_back({static_cast<float>(x), static_cast<float>(y), measured_m, 0.1F});
  }

  [[nodiscard]] std::vector<SurfacePoint> found_in(PatchSurfaces& memory, int threads = 1) const {
    const auto surfaces = memory.find(model, kCamera, SE3{}, kDepth, pixels, first, Workers(threads));
    return {surfaces.begin(), surfaces.end()};
  }
};

void expect_same(const std::vector<SurfacePoint>& a, const std::vector<SurfacePoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].valid, b[i].valid) << i;
    ASSERT_EQ(a[i].depth_m, b[i].depth_m) << i;
    ASSERT_EQ(a[i].normal_world, b[i].normal_world) << i;
  }
}

TEST(PatchSurfaces, AreWhereTheRaysMeetTheModel) {
  const Cut cut;
  PatchSurfaces memory;
  const std::vector<SurfacePoint> surfaces = cut.found_in(memory);
  ASSERT_EQ(surfaces.size(), cut.pixels.size());
  int both = 0;
  int holes = 0;
  int hits = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const ExpectedSurface& pixel = cut.pixels[i];
    const SurfacePoint by_ray = testing::raycast_pixel(
        cut.model, kCamera, SE3{}, static_cast<double>(pixel.u_px), static_cast<double>(pixel.v_px), kDepth);
    hits += by_ray.valid ? 1 : 0;
    if (!by_ray.valid || !surfaces[i].valid) continue;
    ++both;
    holes += pixel.depth_m > 0 ? 0 : 1;
    EXPECT_NEAR(surfaces[i].depth_m, by_ray.depth_m, 0.05 * cut.model.voxel_m()) << i;
  }
  EXPECT_GT(both, 0.98 * hits);
  EXPECT_GT(holes, 100) << "of pixels that nothing was measured at";
}

TEST(PatchSurfaces, NeitherEarlierFramesNorThreadsShow) {
  const Cut cut(12);
  PatchSurfaces fresh;
  const std::vector<SurfacePoint> expected = cut.found_in(fresh);
  PatchSurfaces used;
  for (const Cut& before : {Cut(20, 17), Cut(5, 17)}) {
    static_cast<void>(before.found_in(used));
    expect_same(cut.found_in(used), expected);
  }
  for (const int threads : {2, 4}) expect_same(cut.found_in(used, threads), expected);
}

TEST(PatchSurfaces, AnEmptyModelAndNoPoseHaveNone) {
  const Cut cut;
  const SE3 nowhere{Quaterniond::Identity(), Vector3d::Constant(std::nan(""))};
  const TsdfVolume empty{TsdfConfig{}};
  const Workers workers(1);
  PatchSurfaces memory;
  static_cast<void>(cut.found_in(memory));
  for (const auto& surfaces :
       {memory.find(empty, kCamera, SE3{}, kDepth, cut.pixels, cut.first, workers),
        memory.find(cut.model, kCamera, nowhere, kDepth, cut.pixels, cut.first, workers)}) {
    ASSERT_EQ(surfaces.size(), cut.pixels.size());
    for (const SurfacePoint& surface : surfaces) EXPECT_FALSE(surface.valid);
  }
}

}  // namespace
}  // namespace fusebench
