#include "core/patches/patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/base/image.hpp"
#include "tests/support/gated_depth.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace config;
using namespace preprocessing;
using namespace tsdf;
using namespace patches;

namespace {

/// One frame of the room, fused into a model.
struct FusedFrame {
  PinholeCamera camera = testing::small_camera();
  Config config;
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
    return refresh_patches({pyramid, gated_m, camera, SE3{}}, model, centres, config, workers);
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

TEST(Patches, WithoutAnyMeasuredDepthThePatchTrustsTheModel) {
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
