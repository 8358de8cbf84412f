// The model: integration, ray casting, meshing. Arguments: image width (pixels), threads.
#include <benchmark/benchmark.h>

#include "core/marching_cubes.hpp"
#include "core/raycast.hpp"
#include "tests/bench/model_answers.hpp"

namespace fusebench {
namespace {

using testing::bench_scene;
using testing::BenchScene;
using testing::DepthCheck;
using testing::is_zero_level;
using testing::is_zero_on_surface;
using testing::patch_pixels;

Workers workers_of(const benchmark::State& state) { return Workers(static_cast<int>(state.range(1))); }
const BenchScene& scene_of(const benchmark::State& state) {
  return bench_scene(static_cast<int>(state.range(0)));
}

void raycast_patches(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  const auto pixels = patch_pixels(scene.camera);
  std::vector<SurfacePoint> points;
  const auto cast = [&] {
    raycast_pixels(scene.model, scene.camera, scene.T_world_camera, pixels, scene.config.depth, workers,
                   points);
  };
  DepthCheck depth(scene);
  cast();
  depth.add(pixels, points);
  if (!depth.passed()) return state.SkipWithError("depth is not that of the room");
  for (auto _ : state) cast();
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pixels.size()));
}

void raycast_whole_image(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  const auto cast = [&] {
    return raycast_image(scene.model, scene.camera, scene.T_world_camera, scene.config.depth, workers);
  };
  DepthCheck depth(scene);
  depth.add(cast().depth_m);
  if (!depth.passed()) return state.SkipWithError("depth is not that of the room");
  for (auto _ : state) benchmark::DoNotOptimize(cast());
  state.SetItemsProcessed(state.iterations() * scene.camera.width_px * scene.camera.height_px);
}

/// A frame into a model that has its blocks already, as most frames are.
void integrate(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  TsdfVolume model = scene.model;
  const auto fuse = [&] {
    return model.integrate(scene.frame, scene.camera, scene.T_world_camera, scene.config.depth, workers)
        .has_value();
  };
  if (!fuse() || !is_zero_on_surface(model, scene))
    return state.SkipWithError("the field is not zero on the surface");
  for (auto _ : state) benchmark::DoNotOptimize(fuse());
  state.SetItemsProcessed(state.iterations() * scene.camera.width_px * scene.camera.height_px);
}

void mesh(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  const auto extract = [&] { return extract_mesh(scene.model, 1.0, workers); };
  const Mesh surface = extract();
  if (!is_zero_level(surface, scene.model))
    return state.SkipWithError("the mesh is not the zero level of the field");
  for (auto _ : state) benchmark::DoNotOptimize(extract());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(surface.triangles.size()));
}

const std::vector<std::vector<std::int64_t>> kSizes = {{320, 640}, {1, 2}};
BENCHMARK(raycast_patches)->ArgsProduct(kSizes)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(raycast_whole_image)->ArgsProduct(kSizes)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(integrate)->ArgsProduct(kSizes)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(mesh)->ArgsProduct(kSizes)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace fusebench
