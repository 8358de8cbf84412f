#include "core/estimator/patches/patch_deformation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/config/groups/terms_config.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace patches;

namespace {

constexpr int kSize = 10;

/// A patch of one level, cut by hand from a scene that gives the depth at each pixel of the reference camera
/// (identity).
template <class DepthAt>
Patch cut(const Eigen::Vector2i& centre, const DepthAt& depth_at) {
  const PinholeCamera camera = testing::small_camera();
  Patch patch;
  patch.centre_px = centre;
  patch.levels.resize(1);
  for (int y = centre.y() - kSize / 2; y < centre.y() + kSize / 2; ++y) {
    for (int x = centre.x() - kSize / 2; x < centre.x() + kSize / 2; ++x) {
      PatchPixel pixel;
      pixel.reference_pixel = static_cast<std::uint32_t>(y * camera.width_px + x);
      pixel.point_world = camera.back_project(x, y, depth_at(x, y));
      pixel.normal_world = -Eigen::Vector3f::UnitZ();
      patch.levels[0].pixels.push_back(pixel);
    }
  }
  return patch;
}

PosedCamera camera_at(const Vector3d& position_m, const Vector3d& phi_rad = Vector3d::Zero()) {
  return PosedCamera(testing::small_camera(), SE3{so3_exp(phi_rad), position_m}, SE3{});
}

/// Two planes: a near one at 1 m left of column 160, a far one at 2 m from there on.
double two_planes(int x, int) { return x < 160 ? 1.0 : 2.0; }
/// A plane that leans away to the right.
double slanted(int x, int y) {
  const PinholeCamera camera = testing::small_camera();
  const Vector3d ray = camera.back_project(x, y, 1.0);
  const Vector3d normal = Vector3d(-0.5, 0.2, -1.0).normalized();
  return normal.dot(Vector3d(0, 0, 1.5)) / normal.dot(ray);
}

/// Coordinates of the lanes are relative to here.
const Vector3d kOrigin(0.3, -0.2, 1.1);

/// Level 0 of patches, warped to a camera.
LevelLanes warp(std::span<const Patch> patches, const PosedCamera& posed) {
  LevelLanes lanes;
  pack(patches, 0, kOrigin, lanes);
  warp_level(lanes.pixels, lanes.warp_points, PosedLanes(posed, kOrigin), lanes.warped);
  return lanes;
}
LevelLanes warp(const Patch& patch, const PosedCamera& posed) { return warp(std::span(&patch, 1), posed); }

/// One pixel of them.
struct Pixel {
  Vector2d pixel_px;
  bool in_image = false;
  bool visible = false;
};
std::vector<Pixel> pixels_of(const LevelLanes& lanes, std::size_t patch = 0) {
  std::vector<Pixel> pixels;
  for (std::size_t group = lanes.first[patch]; group < lanes.first[patch + 1]; ++group) {
    const WarpedLanes& w = lanes.warped[group];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (lanes.pixels[group].present[lane] == 0) continue;
      pixels.push_back({{w.x[lane], w.y[lane]}, w.in_image[lane] != 0, w.visible[lane] != 0});
    }
  }
  return pixels;
}

constexpr double kTolerance_px = 2e-4;  // single precision

TEST(PatchDeformation, PixelwiseFollowsEachPixelsOwnDepth) {
  Patch patch = cut({160, 120}, two_planes);
  set_deformation(patch, testing::small_camera(), SE3{}, Deformation::pixelwise);
  const double shift_m = 0.05;
  const auto warped = pixels_of(warp(patch, camera_at({shift_m, 0, 0})));
  for (std::size_t i = 0; i < warped.size(); ++i) {
    const int x = static_cast<int>(patch.levels[0].pixels[i].reference_pixel % 320);
    // Moving right by b moves a point at depth z left by f b / z.
    EXPECT_NEAR(warped[i].pixel_px.x(), x - 240.0 * shift_m / two_planes(x, 0), kTolerance_px);
  }
}

TEST(PatchDeformation, ShrinkTestRemovesTheOccludedFarPlaneAndNothingElse) {
  // The camera moves left: the near plane slides right over the far one by 12 - 6 = 6 pixels, so that the 5
  // columns of the far plane vanish behind the near one as far as the patch covers them.
  Patch patch = cut({160, 120}, two_planes);
  set_deformation(patch, testing::small_camera(), SE3{}, Deformation::pixelwise);
  LevelLanes lanes = warp(patch, camera_at({-0.05, 0, 0}));
  MutualOcclusion occlusion;
  occlusion.resize(320, 240);
  occlusion.test(lanes.warped, DepthConfig{}, ShrinkTest::depth_jump);
  const auto warped = pixels_of(lanes);
  for (std::size_t i = 0; i < warped.size(); ++i) {
    const int x = static_cast<int>(patch.levels[0].pixels[i].reference_pixel % 320);
    const double landed = x + 240.0 * 0.05 / two_planes(x, 0);
    // Near columns 155..159 land on 167..171; far columns 160..164 on 166..170.
    const bool hidden = x >= 160 && landed >= 167.0 - 1e-6 && landed <= 171.0 + 1e-6;
    EXPECT_EQ(warped[i].visible, !hidden) << "column " << x;
    EXPECT_TRUE(warped[i].in_image);
  }
}

TEST(PatchDeformation, AnOccluderInAnotherPatchCounts) {
  Patch near = cut({100, 120}, [](int, int) { return 1.0; });
  Patch far = cut({106, 120}, [](int, int) { return 2.0; });
  for (Patch* patch : {&near, &far})
    set_deformation(*patch, testing::small_camera(), SE3{}, Deformation::pixelwise);
  const PosedCamera posed = camera_at({-0.05, 0, 0});  // near: +12 px, far: +6 px: the squares coincide
  const std::vector<Patch> both = {near, far};
  MutualOcclusion occlusion;
  occlusion.resize(320, 240);
  for (int time = 0; time < 2; ++time) {  // it forgets the test before
    LevelLanes lanes = warp(both, posed);
    occlusion.test(lanes.warped, DepthConfig{}, ShrinkTest::depth_jump);
    for (const Pixel& pixel : pixels_of(lanes, 0)) EXPECT_TRUE(pixel.visible);
    for (const Pixel& pixel : pixels_of(lanes, 1)) EXPECT_FALSE(pixel.visible);
  }
  LevelLanes alone = warp(far, posed);
  occlusion.test(alone.warped, DepthConfig{}, ShrinkTest::depth_jump);
  for (const Pixel& pixel : pixels_of(alone)) EXPECT_TRUE(pixel.visible);
}

TEST(PatchDeformation, BackingAwayFromOneSurfaceHidesNothing) {
  // Pixels of a slanted plane collide when the camera backs off: that is no occlusion.
  Patch patch = cut({160, 120}, slanted);
  set_deformation(patch, testing::small_camera(), SE3{}, Deformation::pixelwise);
  LevelLanes lanes = warp(patch, camera_at({0, 0, -1.5}));
  MutualOcclusion occlusion;
  occlusion.resize(320, 240);
  occlusion.test(lanes.warped, DepthConfig{}, ShrinkTest::depth_jump);
  for (const Pixel& pixel : pixels_of(lanes)) EXPECT_TRUE(pixel.visible);
  EXPECT_FALSE(is_extended(lanes.warped, kSize));
  // To the letter of the paper, it is one: of the pixels in one cell only the nearest stays.
  occlusion.test(lanes.warped, DepthConfig{}, ShrinkTest::any_collision);
  std::set<std::pair<long, long>> cells;
  for (const Pixel& pixel : pixels_of(lanes)) {
    if (!pixel.visible) continue;
    const bool first = cells.emplace(std::lround(pixel.pixel_px.x()), std::lround(pixel.pixel_px.y())).second;
    EXPECT_TRUE(first) << "two visible pixels in one cell";
  }
  EXPECT_GT(cells.size(), 10U);
  EXPECT_LT(cells.size(), 60U) << "the square is seen at half its size";
}

TEST(PatchDeformation, ExtendTestSeesTheOpeningGapAndTheApproach) {
  Patch patch = cut({160, 120}, two_planes);
  set_deformation(patch, testing::small_camera(), SE3{}, Deformation::pixelwise);
  EXPECT_FALSE(is_extended(warp(patch, camera_at({0, 0, 0})).warped, kSize));
  EXPECT_FALSE(is_extended(warp(patch, camera_at({0, 0, 0}, {0, 0.02, 0})).warped, kSize)) << "pure rotation";
  EXPECT_TRUE(is_extended(warp(patch, camera_at({0.05, 0, 0})).warped, kSize)) << "near and far plane part";
  EXPECT_TRUE(is_extended(warp(patch, camera_at({0, 0, 0.4})).warped, kSize)) << "approach";
}

TEST(PatchDeformation, APixelOfGrowthIsAnExtension) {
  // Moving right by b parts both planes by f b / 1 m - f b / 2 m: pixel centres span 9 + 120 b / m pixels.
  Patch patch = cut({160, 120}, two_planes);
  set_deformation(patch, testing::small_camera(), SE3{}, Deformation::pixelwise);
  EXPECT_FALSE(is_extended(warp(patch, camera_at({0.98 / 120, 0, 0})).warped, kSize));
  EXPECT_TRUE(is_extended(warp(patch, camera_at({1.02 / 120, 0, 0})).warped, kSize));
}

TEST(PatchDeformation, MeasuredDepthHidesWhatIsBehindOrGone) {
  Patch patch = cut({160, 120}, [](int, int) { return 1.5; });
  set_deformation(patch, testing::small_camera(), SE3{}, Deformation::pixelwise);
  DepthImage depth(320, 240, 1.5F);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 158; ++x) depth(x, y) = 1.0F;    // a hand before the left part
    for (int x = 162; x < 320; ++x) depth(x, y) = 0.0F;  // no measurement on the right
  }
  LevelLanes lanes = warp(patch, camera_at({0, 0, 0}));
  test_measured_occlusion(lanes.warped, depth, 1, 0.05, DepthConfig{});
  const auto warped = pixels_of(lanes);
  for (std::size_t i = 0; i < warped.size(); ++i) {
    EXPECT_EQ(warped[i].visible, patch.levels[0].pixels[i].reference_pixel % 320 >= 158);
  }
}

/// Number of visible pixels of a patch behind a near one in the same cells.
std::size_t visible_behind(double near_m, double behind_m, const DepthConfig& depth,
                           ShrinkTest rule = ShrinkTest::depth_jump) {
  std::vector<Patch> patches = {cut({100, 120}, [&](int, int) { return near_m; }),
                                cut({100, 120}, [&](int, int) { return near_m + behind_m; })};
  for (Patch& patch : patches) set_deformation(patch, testing::small_camera(), SE3{}, Deformation::pixelwise);
  LevelLanes lanes = warp(patches, camera_at({0, 0, 0}));
  MutualOcclusion occlusion;
  occlusion.resize(320, 240);
  occlusion.test(lanes.warped, depth, rule);
  for (const Pixel& pixel : pixels_of(lanes, 0)) EXPECT_TRUE(pixel.visible);
  std::size_t visible = 0;
  for (const Pixel& pixel : pixels_of(lanes, 1)) visible += pixel.visible ? 1U : 0U;
  return visible;
}

TEST(PatchDeformation, ShrinkTestHasItsLimitAtTheJumpOrAtThreeSigmas) {
  constexpr std::size_t kAll = kSize * kSize;
  DepthConfig depth;
  depth.edge_jump = 0.04;  // wider than 3 sigma at 1.5 m, which is 0.0105 m
  EXPECT_EQ(visible_behind(1.5, 0.98 * 0.04 * 1.5, depth), kAll);
  EXPECT_EQ(visible_behind(1.5, 1.02 * 0.04 * 1.5, depth), 0U);
  depth.edge_jump = 0.001;
  const double three_sigmas_m = 3 * (0.002 + 0.003 * (4.0 - 0.5) * (4.0 - 0.5));
  depth.noise_floor_m = 0.002;
  depth.noise_quadratic_per_m = 0.003;
  depth.noise_offset_m = 0.5;
  EXPECT_EQ(visible_behind(4.0, 0.98 * three_sigmas_m, depth), kAll);
  EXPECT_EQ(visible_behind(4.0, 1.02 * three_sigmas_m, depth), 0U);
  EXPECT_EQ(visible_behind(4.0, 0.001, depth, ShrinkTest::any_collision), 0U);
}

TEST(PatchDeformation, MeasuredDepthHasItsLimitAtTheToleranceOrAtThreeSigmas) {
  DepthConfig depth;
  depth.noise_floor_m = 0.002;
  depth.noise_quadratic_per_m = 0.003;
  depth.noise_offset_m = 0.5;
  Patch patch = cut({160, 120}, [](int, int) { return 3.0; });
  set_deformation(patch, testing::small_camera(), SE3{}, Deformation::pixelwise);
  const auto expect = [&](double measured_m, double tolerance_m, bool visible, bool covered) {
    const DepthImage image(320, 240, static_cast<float>(measured_m));
    LevelLanes lanes = warp(patch, camera_at({0, 0, 0}));
    test_measured_occlusion(lanes.warped, image, 1, tolerance_m, depth);
    for (std::size_t group = 0; group < lanes.warped.size(); ++group) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (lanes.pixels[group].present[lane] == 0) continue;
        EXPECT_EQ(lanes.warped[group].visible[lane] != 0, visible) << measured_m << ", " << tolerance_m;
        EXPECT_EQ(lanes.warped[group].covered[lane] != 0, covered) << measured_m << ", " << tolerance_m;
      }
    }
  };
  const double wide_m = 0.15;  // 3 sigma is about 0.06 m here
  expect(3.0 - 0.98 * wide_m, wide_m, true, false);
  expect(3.0 - 1.02 * wide_m, wide_m, false, true);
  expect(3.0 + 0.98 * wide_m, wide_m, true, false);
  expect(3.0 + 1.02 * wide_m, wide_m, false, false);
  // Sigma is that of the measured depth z: |3 - z| is compared with 3 sigma(z).
  const auto three_sigmas_m = [](double z_m) { return 3 * (0.002 + 0.003 * (z_m - 0.5) * (z_m - 0.5)); };
  const auto at_share = [&](double share) {
    double z_m = 3.0;
    for (int step = 0; step < 50; ++step) z_m = 3.0 - share * three_sigmas_m(z_m);
    return z_m;
  };
  expect(at_share(0.98), 0.01, true, false);
  expect(at_share(1.02), 0.01, false, true);
  expect(at_share(-0.98), 0.01, true, false);
  expect(at_share(-1.02), 0.01, false, false);
}

TEST(PatchDeformation, AllKindsAgreeWhereTheyMustAndDifferWhereTheyMust) {
  const PosedCamera sideways = camera_at({0.05, 0.02, 0}, {0.01, -0.02, 0.0});
  const auto difference = [&](auto depth_at, Deformation a, Deformation b) {
    Patch first = cut({160, 120}, depth_at);
    Patch second = cut({160, 120}, depth_at);
    set_deformation(first, testing::small_camera(), SE3{}, a);
    set_deformation(second, testing::small_camera(), SE3{}, b);
    const auto wa = pixels_of(warp(first, sideways));
    const auto wb = pixels_of(warp(second, sideways));
    double worst = 0;
    for (std::size_t i = 0; i < wa.size(); ++i)
      worst = std::max(worst, (wa[i].pixel_px - wb[i].pixel_px).norm());
    return worst;
  };
  // On a plane, one plane a patch is exact; a rigid square is not; on two planes neither is.
  EXPECT_LT(difference(slanted, Deformation::pixelwise, Deformation::planar), kTolerance_px);
  EXPECT_GT(difference(slanted, Deformation::pixelwise, Deformation::rigid_square), 0.1);
  EXPECT_GT(difference(two_planes, Deformation::pixelwise, Deformation::planar), 0.5);
  EXPECT_GT(difference(two_planes, Deformation::pixelwise, Deformation::rigid_square), 5.0);
}

TEST(PatchDeformation, RigidSquareMovesByItsCentreAlone) {
  Patch patch = cut({160, 120}, two_planes);
  set_deformation(patch, testing::small_camera(), SE3{}, Deformation::rigid_square);
  const auto warped = pixels_of(warp(patch, camera_at({0.05, 0, 0})));
  for (std::size_t i = 0; i < warped.size(); ++i) {
    const auto key = patch.levels[0].pixels[i].reference_pixel;
    EXPECT_NEAR(warped[i].pixel_px.x(), key % 320 - 240.0 * 0.05 / 2.0,
                kTolerance_px);  // the centre is on the far plane
    EXPECT_NEAR(warped[i].pixel_px.y(), key / 320, kTolerance_px);
  }
}

TEST(PatchDeformation, PixelsBehindTheCameraOrOutsideAreNotInTheImage) {
  Patch patch = cut({160, 120}, [](int, int) { return 1.0; });
  set_deformation(patch, testing::small_camera(), SE3{}, Deformation::pixelwise);
  for (const PosedCamera& posed :
       {camera_at({0, 0, 1.5}), camera_at({5, 0, 0}), camera_at({0, 0, 0}, {0, 3.1, 0})}) {
    for (const Pixel& pixel : pixels_of(warp(patch, posed))) EXPECT_FALSE(pixel.in_image);
  }
}

}  // namespace
}  // namespace fusebench
