// What the benchmarks of the estimator's kernels work on: the textured room, seen and fused at one image
// size.
#pragma once

#include <map>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/tsdf_volume.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench::testing {

/// Three near views of the room, fused; the truth at the last of them is `frame`.
struct BenchScene {
  PinholeCamera camera;
  Config config;
  SE3 T_world_camera;
  RgbdFrame frame;
  TsdfVolume model{config.tsdf};
};

/// The scene at a width of 320 or 640 pixels (67 degrees of view); made once.
inline const BenchScene& bench_scene(int width_px) {
  static std::map<int, BenchScene> scenes;
  const auto found = scenes.find(width_px);
  if (found != scenes.end()) return found->second;
  BenchScene& scene = scenes[width_px];
  scene.config.patches.fast_threshold = 2;  // the room's texture is soft, more so in larger images
  const double focal_px = 0.75 * width_px;
  const int height_px = width_px * 3 / 4;
  scene.camera = {width_px, height_px, focal_px, focal_px, 0.5 * (width_px - 1), 0.5 * (height_px - 1)};
  const Workers workers(1);  // more would leave threads behind that take turns with what is measured
  for (int view = 0; view < 3; ++view) {
    scene.T_world_camera = {so3_exp({0.02 * view, -0.03 * view, 0.01 * view}),
                            {0.03 * view, 0.0, -0.02 * view}};
    scene.frame = TexturedRoom{}.render(scene.camera, scene.T_world_camera, view);
    const auto fused =
        scene.model.integrate(scene.frame, scene.camera, scene.T_world_camera, scene.config.depth, workers);
    check(fused.has_value(), "the scene fits into the model");
  }
  return scene;
}

}  // namespace fusebench::testing
