// The model: blocks, integration, ray casting, meshing.
#include <benchmark/benchmark.h>

#include <optional>

#include "core/estimator/model/meshing/marching_cubes.hpp"
#include "tests/bench/bench_scene.hpp"
#include "tests/bench/model_answers.hpp"
#include "tests/bench/rates.hpp"
#include "tests/bench/scene_arguments.hpp"

namespace fusebench {

using namespace tsdf;
using namespace raycast;
using namespace meshing;

namespace {

using testing::BenchScene;
using testing::bytes_of;
using testing::FusedVoxels;
using testing::over_scenes_and_threads;
using testing::report_rates;
using testing::scene_of;
using testing::SceneKind;
using testing::workers_of;

void band_blocks(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  BandBlocks band;
  const auto find = [&] {
    band.find(scene.frame.depth_m, scene.camera, scene.T_world_camera, kBlockSide * scene.config.tsdf.voxel_m,
              scene.config.tsdf, scene.config.depth, 0, workers);
  };
  find();
  if (!testing::are_band_blocks(band.blocks(), scene))
    return state.SkipWithError("not the blocks around the measurements");
  for (auto _ : state) find();
  const std::size_t pixels = scene.frame.depth_m.data.size();
  // Every second row of depth in, since caches know nothing smaller (every second pixel may do); blocks out.
  report_rates(
      state, {"pixels", pixels, 0.5 * bytes_of<float>(pixels) + bytes_of<BlockIndex>(band.blocks().size())});
  state.counters["blocks"] = static_cast<double>(band.blocks().size());
}

// Bytes that a voxel has: distance and weight; colour and its count.
constexpr std::size_t kField = sizeof(*BlockVoxels{}.distance_m) + sizeof(*BlockVoxels{}.weight);
constexpr std::size_t kColor = sizeof(*BlockVoxels{}.color);

/// Field of voxels that a frame changes, and the colour of those near the surface, in and out; the frame in.
double bytes_of_fusion(const FusedVoxels& fused, const BenchScene& scene) {
  const std::size_t pixels = scene.frame.depth_m.data.size();
  return 2.0 * static_cast<double>(kField * fused.updated + kColor * fused.colored) +
         bytes_of<float>(pixels) + bytes_of<Rgb>(pixels);
}

/// What VoxelUpdate's formulas ask for.
double flop_of_fusion(const FusedVoxels& fused) {
  // Each voxel of a block: three coordinates by a step (3), its pixel (1 + 2 * 4).
  constexpr std::size_t kProjected = 12;
  // One that is observed: depth noise (4), band and half of it (2), distance (1), weight (6), mean (5).
  constexpr std::size_t kUpdated = 18;
  // One with colour: share (2), mean of three channels (3 * 5), count (1).
  constexpr std::size_t kColored = 18;
  return static_cast<double>(kProjected * kBlockVoxels * fused.blocks + kUpdated * fused.updated +
                             kColored * fused.colored);
}

void report_fusion(benchmark::State& state, const FusedVoxels& fused, double bytes) {
  report_rates(state, {"voxels", kBlockVoxels * fused.blocks, bytes, flop_of_fusion(fused)});
  state.counters["blocks"] = static_cast<double>(fused.blocks);
  state.counters["updated"] = static_cast<double>(fused.updated);
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
  const bool fits = fuse();
  const FusedVoxels fused = testing::fused_voxels(scene.model, model, scene);
  if (!fits || !fused.as_plain) return state.SkipWithError("voxels are not what plain formulas say");
  if (scene.kind == SceneKind::room && !testing::is_zero_on_surface(model, scene))
    return state.SkipWithError("the field is not zero on the surface");
  for (auto _ : state) benchmark::DoNotOptimize(fuse());
  report_fusion(state, fused, bytes_of_fusion(fused, scene));
}

/// A frame into a model without any blocks, as the first one is.
void integrate_into_nothing(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  std::optional<TsdfVolume> model;
  const auto fuse = [&] {
    return model->integrate(scene.frame, scene.camera, scene.T_world_camera, scene.config.depth, workers)
        .has_value();
  };
  const TsdfVolume nothing(scene.config.tsdf);
  model.emplace(scene.config.tsdf);
  const bool fits = fuse();
  const FusedVoxels fused = testing::fused_voxels(nothing, *model, scene);
  if (!fits || !fused.as_plain || model->block_count() != fused.blocks)
    return state.SkipWithError("voxels are not what plain formulas say");
  for (auto _ : state) {
    state.PauseTiming();
    model.emplace(scene.config.tsdf);
    state.ResumeTiming();
    benchmark::DoNotOptimize(fuse());
  }
  // New blocks are written as a whole before voxels are changed.
  report_fusion(
      state, fused,
      static_cast<double>((kField + kColor) * kBlockVoxels * fused.blocks) + bytes_of_fusion(fused, scene));
}

/// rays: as long as they are said to be; every so many-th one is felt along. Each answer in the room is held
/// against what was rendered as well.
void cast_rays(benchmark::State& state, const std::vector<PixelRay>& rays, std::size_t every) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  std::vector<SurfacePoint> points;
  const auto cast = [&] {
    testing::raycast_pixels(scene.model, scene.camera, scene.T_world_camera, rays, scene.config.depth,
                            workers, points);
  };
  cast();
  testing::DepthCheck depth(scene);
  depth.add(rays, points);
  if (scene.kind == SceneKind::room && !depth.passed())
    return state.SkipWithError("depth is not that of the room");
  if (!testing::PlainRays(scene).agree(rays, points, every))
    return state.SkipWithError("not what is felt for in small steps");
  for (auto _ : state) cast();
  // Pixels in, surfaces out; and the voxels around these.
  report_rates(state, {"rays", rays.size(),
                       bytes_of<PixelRay>(rays.size()) + bytes_of<SurfacePoint>(rays.size()) +
                           bytes_of<float>(testing::voxels_around(scene, rays, points))});
}

void raycast_patches(benchmark::State& state) {
  cast_rays(state, testing::patch_pixels(scene_of(state).camera), 7);
}

/// From some decimetres before what was measured to as far behind it.
void raycast_around_depth(benchmark::State& state) {
  constexpr float kReach_m = 0.15F;
  const BenchScene& scene = scene_of(state);
  std::vector<PixelRay> rays = testing::patch_pixels(scene.camera);
  for (PixelRay& ray : rays) {
    const float depth_m = scene.frame.depth_m(static_cast<int>(ray.u_px), static_cast<int>(ray.v_px));
    if (!(depth_m > 0)) continue;
    ray.begin_m = depth_m - kReach_m;
    ray.end_m = depth_m + kReach_m;
  }
  cast_rays(state, rays, 7);
}

void raycast_whole_image(benchmark::State& state) {
  cast_rays(state, testing::image_rays(scene_of(state).camera), 151);
}

void marching_cubes(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = workers_of(state);
  const auto extract = [&] { return extract_mesh(scene.model, 1.0, workers); };
  const Mesh surface = extract();
  if (!testing::is_zero_level(surface, scene.model))
    return state.SkipWithError("the mesh is not the zero level of the field");
  for (auto _ : state) benchmark::DoNotOptimize(extract());
  const std::size_t voxels = kBlockVoxels * scene.model.block_count();
  // Distances and weights in; vertices with normals and colours, and triangles, out.
  report_rates(state, {"voxels", voxels,
                       bytes_of<float>(2 * voxels) + bytes_of<Eigen::Vector3f>(2 * surface.vertices.size()) +
                           bytes_of<Rgb>(surface.colors.size()) +
                           bytes_of<std::array<std::uint32_t, 3>>(surface.triangles.size())});
  state.counters["triangles"] = static_cast<double>(surface.triangles.size());
}

BENCHMARK(band_blocks)->Apply(over_scenes_and_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(integrate)->Apply(over_scenes_and_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(integrate_into_nothing)->Apply(over_scenes_and_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(raycast_patches)->Apply(over_scenes_and_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(raycast_around_depth)->Apply(over_scenes_and_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(raycast_whole_image)->Apply(over_scenes_and_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(marching_cubes)->Apply(over_scenes_and_threads)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
