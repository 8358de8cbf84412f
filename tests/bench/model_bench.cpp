// The model: integration, ray casting, meshing. Arguments: image width (pixels), threads.
#include <benchmark/benchmark.h>

#include <cmath>

#include "core/marching_cubes.hpp"
#include "core/raycast.hpp"
#include "tests/bench/bench_scene.hpp"

namespace fusebench {
namespace {

using testing::bench_scene;
using testing::BenchScene;

Workers workers_of(const benchmark::State& state) { return Workers(static_cast<int>(state.range(1))); }
const BenchScene& scene_of(const benchmark::State& state) {
  return bench_scene(static_cast<int>(state.range(0)));
}

/// Surface points against the rendered truth: found almost everywhere, and nearly all of them within a voxel
/// (at the edges of the furniture the model is rounded).
class DepthCheck {
 public:
  explicit DepthCheck(const BenchScene& scene) : scene_(scene) {}
  void add(int x, int y, double depth_m) {
    ++asked_;
    if (depth_m <= 0) return;
    ++found_;
    const double error_m = std::abs(depth_m - static_cast<double>(scene_.frame.depth_m(x, y)));
    if (error_m < scene_.config.tsdf.voxel_m) ++close_;
  }
  [[nodiscard]] bool passed() const { return found_ > 0.9 * asked_ && close_ > 0.97 * found_; }

 private:
  const BenchScene& scene_;
  double asked_ = 0;
  double found_ = 0;
  double close_ = 0;
};

/// The pixels of 100 patches of 10x10.
std::vector<Vector2d> patch_pixels(const PinholeCamera& camera) {
  std::vector<Vector2d> pixels;
  for (int patch = 0; patch < 100; ++patch) {
    const int x0 = (patch % 10 + 1) * camera.width_px / 12;
    const int y0 = (patch / 10 + 1) * camera.height_px / 12;
    for (int i = 0; i < 100; ++i) pixels.emplace_back(x0 + i % 10, y0 + i / 10);
  }
  return pixels;
}

void raycast_patches(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  const auto pixels = patch_pixels(scene.camera);
  const auto cast = [&] {
    return raycast_pixels(scene.model, scene.camera, scene.T_world_camera, pixels, scene.config.depth,
                          workers);
  };
  DepthCheck depth(scene);
  const auto points = cast();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    depth.add(static_cast<int>(pixels[i].x()), static_cast<int>(pixels[i].y()),
              points[i].valid ? points[i].depth_m : 0.0);
  }
  if (!depth.passed()) return state.SkipWithError("depth is not that of the room");
  for (auto _ : state) benchmark::DoNotOptimize(cast());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pixels.size()));
}

void raycast_whole_image(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  const auto cast = [&] {
    return raycast_image(scene.model, scene.camera, scene.T_world_camera, scene.config.depth, workers);
  };
  DepthCheck depth(scene);
  const SurfaceImage surface = cast();
  for (int y = 0; y < scene.camera.height_px; ++y) {
    for (int x = 0; x < scene.camera.width_px; ++x) {
      depth.add(x, y, static_cast<double>(surface.depth_m(x, y)));
    }
  }
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
  bool passed = fuse();
  // On the surface that was fused the field is zero, within a voxel, wherever it can be interpolated.
  double error_m = 0;
  int sampled = 0;
  for (const Vector2d& pixel : patch_pixels(scene.camera)) {
    const double depth_m =
        static_cast<double>(scene.frame.depth_m(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())));
    const TsdfSample sample =
        model.sample(scene.T_world_camera * scene.camera.back_project(pixel.x(), pixel.y(), depth_m));
    if (!sample.valid) continue;
    ++sampled;
    error_m += std::abs(sample.distance_m);
  }
  passed = passed && sampled > 5000 && error_m < sampled * scene.config.tsdf.voxel_m;
  if (!passed) return state.SkipWithError("the field is not zero on the surface");
  for (auto _ : state) benchmark::DoNotOptimize(fuse());
  state.SetItemsProcessed(state.iterations() * scene.camera.width_px * scene.camera.height_px);
}

void mesh(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  const auto extract = [&] { return extract_mesh(scene.model, 1.0, workers); };
  const Mesh surface = extract();
  bool passed = surface.triangles.size() > 1000;
  for (const auto& triangle : surface.triangles) {
    for (const std::uint32_t corner : triangle) passed = passed && corner < surface.vertices.size();
  }
  // Vertices lie where the field crosses zero.
  for (const Eigen::Vector3f& vertex : surface.vertices) {
    const TsdfSample sample = scene.model.sample(vertex.cast<double>());
    passed = passed && (!sample.valid || std::abs(sample.distance_m) < 1e-4);
  }
  if (!passed) return state.SkipWithError("the mesh is not the zero level of the field");
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
