// Patches: cutting and packing them, and the frame's update with its linearisations and trials.
#include <benchmark/benchmark.h>

#include "tests/bench/bench_scene.hpp"
#include "tests/bench/patch_answers.hpp"
#include "tests/bench/rates.hpp"
#include "tests/bench/scene_arguments.hpp"

namespace fusebench {

using namespace simd;
using namespace filter;
using namespace patches;
using namespace measurement;

namespace {

using testing::BenchScene;
using testing::bytes_of;
using testing::over_scenes_and_threads;
using testing::PatchProblem;
using testing::report_rates;
using testing::ResidualCounts;
using testing::scene_of;
using testing::workers_of;

/// Where all patches of a frame are thought to be in it: nearly where they were cut.
std::vector<TrackedCentre> tracked_centres(const std::vector<Patch>& patches) {
  std::vector<TrackedCentre> centres;
  for (const Patch& patch : patches)
    centres.push_back({patch.centre_px.cast<double>() + Vector2d(0.3, -0.2), patch.age + 1});
  return centres;
}

/// survivors: of the patches of the frame before.
void refresh(benchmark::State& state, const PatchProblem& problem, const Workers& workers,
             const std::vector<TrackedCentre>& survivors) {
  PatchWorkspace memory;
  std::vector<Patch> patches;
  const auto cut = [&] {
    refresh_patches(problem.reference(), problem.scene.model, survivors,
                    {problem.config.patches, problem.config.depth, problem.config.terms.deformation}, workers,
                    memory, patches);
  };
  cut();
  if (!testing::are_cut_from(patches, problem.reference()))
    return state.SkipWithError("patches are not cut from the frame");
  for (auto _ : state) cut();
  // The pixels of the patches out, a grey level and a depth of each in; the image, where corners are looked
  // for. What rays read comes on top.
  const std::size_t pixels = testing::pixels_of(patches);
  report_rates(state, {"patch pixels", pixels,
                       bytes_of<PatchPixel>(pixels) + bytes_of<float>(pixels) +
                           bytes_of<std::uint8_t>(pixels + problem.pyramid[0].data.size())});
  state.counters["patches"] = static_cast<double>(patches.size());
}

/// All from new corners, as after a loss.
void refresh_new_patches(benchmark::State& state) {
  const Workers workers = workers_of(state);
  const PatchProblem problem(scene_of(state), workers);
  refresh(state, problem, workers, {});
}

/// Most from survivors, as after a frame that was tracked.
void refresh_kept_patches(benchmark::State& state) {
  const Workers workers = workers_of(state);
  const PatchProblem problem(scene_of(state), workers);
  refresh(state, problem, workers, tracked_centres(problem.patches));
}

/// All levels, by the number of patches that are asked for.
void pack_patches(benchmark::State& state) {
  const Workers workers(1);
  const PatchProblem problem(scene_of(state), workers, static_cast<int>(state.range(2)));
  const Vector3d origin_world = problem.patches.front().levels[0].pixels.front().point_world;
  std::vector<LevelLanes> levels(problem.pyramid.size());
  const auto pack_all = [&] {
    for (std::size_t level = 0; level < levels.size(); ++level)
      pack(problem.patches, level, origin_world, levels[level]);
  };
  pack_all();
  std::size_t groups = 0;
  for (std::size_t level = 0; level < levels.size(); ++level) {
    groups += levels[level].pixels.size();
    if (!testing::are_packed(levels[level], problem.patches, level, origin_world))
      return state.SkipWithError("lanes do not hold the pixels");
  }
  for (auto _ : state) pack_all();
  const std::size_t pixels = testing::pixels_of(problem.patches);
  // Pixels in, lanes out.
  report_rates(state, {"patch pixels", pixels, bytes_of<PatchPixel>(pixels) + bytes_of<PixelLanes>(groups)});
  state.counters["patches"] = static_cast<double>(problem.patches.size());
}

/// Packed pixels, their grey levels and their depth in; the associations that trials go on with out.
double bytes_of_linearisation(const ResidualCounts& counts) {
  return (bytes_of<PixelLanes>(counts.pixels) + bytes_of<PlanePairs>(counts.geometric)) /
             static_cast<double>(kLanes) +
         bytes_of<std::uint8_t>(counts.photometric) + bytes_of<float>(counts.geometric);
}

/// What the formulas of patch_sums.hpp ask for.
double flop_of_linearisation(const ResidualCounts& counts) {
  // Into the camera (18), onto the image (7).
  constexpr std::size_t kWarped = 25;
  // Bicubic sample with slopes (146), residual, Huber and weight (9), Jacobian (66), normal equations (61),
  // those of the brightness (33), fit (4).
  constexpr std::size_t kPhotometric = 319;
  // The pixel where the point lands in the camera (27), what was measured there and how far off (15), its
  // normal from four neighbours (39), gates (39), noise, and point in the IMU's frame (30), residual, Huber
  // and weight (33), Jacobian (24), normal equations (61), fit (4).
  constexpr std::size_t kGeometric = 272;
  return static_cast<double>(kWarped * counts.pixels + kPhotometric * counts.photometric +
                             kGeometric * counts.geometric);
}

/// All patches of a frame against a frame, from a pose that is off by what a prediction is off.
void linearise(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(3)));
  const PatchProblem problem(scene_of(state), workers, static_cast<int>(state.range(2)));
  const auto in_frame = problem.measurement(workers);
  PatchMeasurement& measurement = *in_frame;
  const SE3 start = problem.start();
  const auto once = [&] { return measurement.linearise({start, start}, measurement.stages() - 1, true); };

  // The Gauss-Newton step lowers the cost that was linearised, and leads to where the patches fit: nearly all
  // of the way on rendered frames, about half of it on real ones, where the cost is less round.
  constexpr double kMostErrorLeft = 0.6;
  const MeasurementQuadratic parts = once();
  const auto [stepped, tangents] = PatchProblem::step_by(parts, start);
  if (!(measurement.trial_cost({stepped, stepped}, tangents, 1.0) < parts.cost()) ||
      !(problem.error_m(stepped) < kMostErrorLeft * problem.error_m(start))) {
    return state.SkipWithError("the step does not lead to the true pose");
  }
  if (!testing::is_slope_of_cost(measurement, once(), start))
    return state.SkipWithError("the gradient is not the slope of the cost");
  for (auto _ : state) benchmark::DoNotOptimize(once());
  const ResidualCounts counts = testing::residual_counts(measurement, problem.patches, false);
  report_rates(
      state, {"patch pixels", counts.pixels, bytes_of_linearisation(counts), flop_of_linearisation(counts)});
  state.counters["patches"] = static_cast<double>(problem.patches.size());
}

/// The cost of a step, with what the linearisation before it has fixed.
void trial_cost(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(3)));
  const PatchProblem problem(scene_of(state), workers, static_cast<int>(state.range(2)));
  const auto in_frame = problem.measurement(workers);
  PatchMeasurement& measurement = *in_frame;
  const SE3 start = problem.start();
  const MeasurementQuadratic parts = measurement.linearise({start, start}, measurement.stages() - 1, true);
  if (!testing::is_slope_of_cost(measurement, parts, start))
    return state.SkipWithError("the slope of the cost is not the gradient");
  const auto [stepped, tangents] = PatchProblem::step_by(parts, start);
  const PoseHypothesis poses{stepped, stepped};
  const auto once = [&] { return measurement.trial_cost(poses, tangents, 1.0); };
  if (!(once() < parts.cost())) return state.SkipWithError("the step does not lower the cost");
  for (auto _ : state) benchmark::DoNotOptimize(once());
  const ResidualCounts counts = testing::residual_counts(measurement, problem.patches, true);
  // Onto the image (25), bicubic value (74), residual and Huber (7); a plane's residual and Huber (30).
  const double flop = static_cast<double>(106 * counts.photometric + 30 * counts.geometric);
  report_rates(state, {"patch pixels", counts.pixels, bytes_of_linearisation(counts), flop});
  state.counters["patches"] = static_cast<double>(problem.patches.size());
}

/// A frame's update, from its patches on: packing, linearisations and trials of three levels, and the filter.
void iekf_update_of_frame(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(3)));
  const PatchProblem problem(scene_of(state), workers, static_cast<int>(state.range(2)));
  const GaussianState prior = problem.prior();
  const IekfResult result = problem.update(prior, workers);
  if (!problem.is_updated(result)) return state.SkipWithError("the update does not lead to the true pose");
  for (auto _ : state) benchmark::DoNotOptimize(problem.update(prior, workers));
  // The patches in, once; the iterations find them in the caches.
  const std::size_t pixels = testing::pixels_of(problem.patches);
  report_rates(state, {"patch pixels", pixels, bytes_of<PatchPixel>(pixels)});
  state.counters["patches"] = static_cast<double>(problem.patches.size());
  state.counters["iterations"] = static_cast<double>(result.iterations);
}

/// Arguments: scene, width, patches that are asked for, threads.
void over_patches_and_threads(benchmark::internal::Benchmark* benchmark) {
  for (const auto& [kind, width_px] : testing::kinds_and_widths()) {
    for (const std::int64_t patches : {25, 100, 200}) {
      for (const std::int64_t threads : {1, 2})
        benchmark->Args({static_cast<std::int64_t>(kind), width_px, patches, threads});
    }
  }
  benchmark->ArgNames({"scene", "width", "patches", "workers"})->UseRealTime();
}

BENCHMARK(refresh_new_patches)->Apply(over_scenes_and_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(refresh_kept_patches)->Apply(over_scenes_and_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(pack_patches)
    ->Apply(testing::over_scenes<25, 100, 200>)
    ->ArgNames({"scene", "width", "patches"})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(linearise)->Apply(over_patches_and_threads)->Unit(benchmark::kMicrosecond);
BENCHMARK(trial_cost)->Apply(over_patches_and_threads)->Unit(benchmark::kMicrosecond);
BENCHMARK(iekf_update_of_frame)
    ->Name("iekf_update")
    ->Apply(over_patches_and_threads)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
