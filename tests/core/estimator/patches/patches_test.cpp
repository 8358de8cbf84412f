#include "core/estimator/patches/patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/image.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/config/groups/terms_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "core/estimator/patches/measured_surfaces.hpp"
#include "tests/support/gated_depth.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace config;
using namespace preprocessing;
using namespace tsdf;
using namespace patches;

namespace {

/// The groups of options that these tests need.
struct PatchesOptions {
  PatchConfig patches;
  DepthConfig depth;
  TsdfConfig tsdf;
};

/// One frame of the room, fused into a model.
struct FusedFrame {
  PinholeCamera camera = testing::small_camera();
  PatchesOptions config;
  Workers workers{1};
  RgbdFrame frame = testing::TexturedRoom{}.render(camera, SE3{}, 0);
  TsdfVolume model{config.tsdf};
  DepthImage gated_m;
  std::vector<GreyImage> pyramid;

  FusedFrame() {
    frame.depth_m = testing::gated_depth(frame.depth_m, config.depth);
    EXPECT_TRUE(model.integrate(frame, camera, SE3{}, config.depth, workers).has_value());
    gated_m = frame.depth_m;
    pyramid = build_pyramid(frame.grey, config.patches.levels);
  }

  [[nodiscard]] std::vector<Patch> cut(const std::vector<TrackedCentre>& centres) const {
    return refresh_patches({pyramid, gated_m, camera, SE3{}}, model, centres,
                           {config.patches, config.depth, Deformation::pixelwise}, workers);
  }

  [[nodiscard]] bool one_surface(const PatchPixel& pixel, int reach_px) const {
    const auto x = static_cast<int>(pixel.reference_pixel) % camera.width_px;
    const auto y = static_cast<int>(pixel.reference_pixel) / camera.width_px;
    return is_one_surface(gated_m, x, y, reach_px, config.depth.edge_jump);
  }
};

TEST(Patches, PixelsAreAlignedByWhereTheySeeOneSurface) {
  const FusedFrame scene;
  const std::vector<Patch> patches = scene.cut({});
  ASSERT_GT(patches.size(), 20U);
  std::size_t mixed = 0;
  for (const Patch& patch : patches) {
    for (std::size_t level = 0; level < patch.levels.size(); ++level) {
      const int reach_px = level == 0 ? 0 : 1 << level;
      for (const PatchPixel& pixel : patch.levels[level].pixels) {
        EXPECT_EQ(pixel.depth_confirmed, scene.one_surface(pixel, reach_px)) << "level " << level;
        mixed += !pixel.depth_confirmed && scene.one_surface(pixel, 0) ? 1U : 0U;
      }
    }
  }
  EXPECT_GT(mixed, 50U) << "the furniture has edges that coarse pixels reach over";
}

TEST(Patches, TheFramesOwnSurfaceIsWhatItMeasured) {
  FusedFrame scene;
  for (float& depth_m : scene.gated_m.data) depth_m *= 1.01F;  // a scale that the model does not have
  const auto worst_depth_error_m = [&](ReferenceSurface surface) {
    scene.config.patches.reference_surface = surface;
    double worst = 0;
    for (const Patch& patch : scene.cut({})) {
      for (const PatchPixel& pixel : patch.levels.front().pixels)
        worst = std::max(worst, std::abs(pixel.point_world.z() -
                                         static_cast<double>(scene.gated_m.data[pixel.reference_pixel])));
    }
    return worst;
  };
  EXPECT_GT(worst_depth_error_m(ReferenceSurface::model), 0.01);
  EXPECT_LT(worst_depth_error_m(ReferenceSurface::frame), 1e-6);
  EXPECT_LT(worst_depth_error_m(ReferenceSurface::frame_ungated), 1e-6);
}

TEST(Patches, ASurfaceIsUsableWithinThreeSigmasOfTheMeasurement) {
  FusedFrame scene;
  scene.config.patches.occlusion_distance_m = 0.001;  // less than three sigmas
  const DepthImage model_m = scene.gated_m;
  const auto pixels_with_depth_off_by = [&](double sigmas) {
    for (std::size_t i = 0; i < model_m.data.size(); ++i) {
      const auto z_m = static_cast<double>(model_m.data[i]);
      scene.gated_m.data[i] =
          z_m > 0 ? static_cast<float>(z_m + sigmas * depth_sigma_m(z_m, scene.config.depth)) : 0.0F;
    }
    std::size_t count = 0;
    for (const Patch& patch : scene.cut({})) count += patch.levels.front().pixels.size();
    return count;
  };
  const std::size_t all = pixels_with_depth_off_by(0.0);
  EXPECT_GT(all, 2000U);
  EXPECT_GT(pixels_with_depth_off_by(2.0), 0.8 * static_cast<double>(all));
  EXPECT_LT(pixels_with_depth_off_by(4.0), 0.1 * static_cast<double>(all));
}

TEST(Patches, NormalsOfTheFrameAreThoseOfThePlane) {
  // A plane with a given normal in the view of a rotated camera.
  const PinholeCamera camera = testing::small_camera();
  const Vector3d normal = Vector3d(0.3, -0.2, -1).normalized();
  DepthImage depth_m(camera.width_px, camera.height_px, 0);
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x)
      depth_m(x, y) = static_cast<float>(-1.5 / normal.dot(camera.back_project(x, y, 1.0)));
  }
  depth_m(200, 100) = 0;
  const SE3 T_world_camera{so3_exp({0.1, 0.4, -0.2}), {1, 2, 3}};
  const std::vector<raycast::ExpectedSurface> pixels = {{100, 80, 0, 0}, {200, 100, 0, 0}, {204, 100, 0, 0}};
  const auto surfaces = measured_surfaces(depth_m, camera, T_world_camera, pixels);
  ASSERT_EQ(surfaces.size(), 3U);
  EXPECT_TRUE(surfaces[0].valid);
  EXPECT_LT((surfaces[0].normal_world - T_world_camera.rotation * normal).norm(), 1e-4);
  EXPECT_FALSE(surfaces[1].valid) << "nothing was measured";
  EXPECT_TRUE(surfaces[2].valid);
  EXPECT_EQ(surfaces[2].normal_world, Vector3d::Zero()) << "a neighbour is missing";
}

TEST(Patches, CoarsePixelsWithoutMeasuredDepthAreLeftOut) {
  FusedFrame scene;
  // A shadow right of a patch: it reaches into its finest square by two columns.
  constexpr int kShadow = 223;
  for (int y = 0; y < 130; ++y) {
    for (int x = kShadow; x < 310; ++x) scene.gated_m(x, y) = 0;
  }
  const std::vector<Patch> patches = scene.cut({{Vector2d(220, 60), 3}});
  const auto survivor =
      std::find_if(patches.begin(), patches.end(), [](const Patch& p) { return p.age > 0; });
  ASSERT_NE(survivor, patches.end());
  for (std::size_t level = 0; level < survivor->levels.size(); ++level) {
    const std::vector<PatchPixel>& pixels = survivor->levels[level].pixels;
    ASSERT_GT(pixels.size(), 30U);
    const auto in_shadow = std::count_if(pixels.begin(), pixels.end(), [&](const PatchPixel& pixel) {
      return static_cast<int>(pixel.reference_pixel) % scene.camera.width_px >= kShadow;
    });
    // The finest ones are compared, whether or not they were measured.
    EXPECT_EQ(in_shadow > 0, level == 0) << "level " << level;
  }
}

TEST(Patches, WithoutMeasuredDepthThePatchUsesTheModel) {
  FusedFrame scene;
  constexpr std::array<int, 2> kMiddle = {220, 60};
  for (int y = 0; y < 130; ++y) {
    for (int x = 130; x < 310; ++x) scene.gated_m(x, y) = 0;
  }
  const std::vector<Patch> patches = scene.cut({{Vector2d(kMiddle[0], kMiddle[1]), 3}});
  const auto survivor =
      std::find_if(patches.begin(), patches.end(), [](const Patch& p) { return p.age > 0; });
  ASSERT_NE(survivor, patches.end());
  for (const PatchLevel& level : survivor->levels) {
    EXPECT_FALSE(level.pixels.empty());
    for (const PatchPixel& pixel : level.pixels) EXPECT_TRUE(pixel.depth_confirmed);
  }
}

}  // namespace
}  // namespace fusebench
