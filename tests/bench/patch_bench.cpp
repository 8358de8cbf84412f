// Patches: corner selection, and one linearisation of the measurement. Arguments: width, threads.
#include <benchmark/benchmark.h>

#include "core/corner_selection.hpp"
#include "tests/bench/patch_problem.hpp"

namespace fusebench {
namespace {

using testing::bench_scene;
using testing::BenchScene;
using testing::PatchProblem;

/// The segment test in its plain form: nine neighbours in a row on the circle of 16 are all brighter, or all
/// darker, by more than the threshold.
bool is_fast_corner(const GreyImage& image, const Eigen::Vector2i& p, int threshold) {
  constexpr std::array<std::array<int, 2>, 16> kCircle = {{{0, -3},
                                                           {1, -3},
                                                           {2, -2},
                                                           {3, -1},
                                                           {3, 0},
                                                           {3, 1},
                                                           {2, 2},
                                                           {1, 3},
                                                           {0, 3},
                                                           {-1, 3},
                                                           {-2, 2},
                                                           {-3, 1},
                                                           {-3, 0},
                                                           {-3, -1},
                                                           {-2, -2},
                                                           {-1, -3}}};
  int brighter = 0;
  int darker = 0;
  for (std::size_t i = 0; i < 16 + 8; ++i) {
    const auto& offset = kCircle[i % 16];
    const int difference = image(p.x() + offset[0], p.y() + offset[1]) - image(p.x(), p.y());
    brighter = difference > threshold ? brighter + 1 : 0;
    darker = difference < -threshold ? darker + 1 : 0;
    if (brighter >= 9 || darker >= 9) return true;
  }
  return false;
}

void corner_selection(benchmark::State& state) {
  const BenchScene& scene = bench_scene(static_cast<int>(state.range(0)));
  const PatchConfig& config = scene.config.patches;
  const auto select = [&] { return select_corners(scene.frame.grey, scene.frame.depth_m, {}, config); };
  const auto corners = select();
  bool passed = corners.size() > 20 && corners.size() <= static_cast<std::size_t>(config.max_count);
  for (std::size_t a = 0; a < corners.size(); ++a) {
    passed = passed && is_fast_corner(scene.frame.grey, corners[a], config.fast_threshold);
    for (std::size_t b = 0; b < a; ++b) {
      passed = passed && (corners[a] - corners[b]).cast<double>().norm() >= config.min_distance_px;
    }
  }
  if (!passed) return state.SkipWithError("these are not spread FAST corners");
  for (auto _ : state) benchmark::DoNotOptimize(select());
}

/// All patches of a frame against that frame, from a pose that is off by what a prediction is off.
void linearise(benchmark::State& state) {
  const BenchScene& scene = bench_scene(static_cast<int>(state.range(0)));
  const Workers workers(static_cast<int>(state.range(1)));
  const PatchProblem problem(scene, workers);
  PatchMeasurement measurement(scene.config, problem.rig, problem.observed, problem.patches, {}, workers);
  const int finest = measurement.stages() - 1;
  const auto once = [&] { return measurement.linearise({problem.start, problem.start}, finest, true); };

  // The Gauss-Newton step lowers the cost that was linearised, and leads back to the true pose.
  const MeasurementQuadratic parts = once();
  const auto [stepped, tangents] = problem.step_by(parts);
  if (!(measurement.trial_cost({stepped, stepped}, tangents, 1.0) < parts.cost()) ||
      !(problem.error_m(stepped) < 0.5 * problem.error_m(problem.start))) {
    return state.SkipWithError("the step does not lead to the true pose");
  }
  for (auto _ : state) benchmark::DoNotOptimize(once());
  state.counters["patches"] = static_cast<double>(problem.patches.size());
}

BENCHMARK(corner_selection)->Arg(320)->Arg(640)->Unit(benchmark::kMillisecond);
BENCHMARK(linearise)->ArgsProduct({{320, 640}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace fusebench
