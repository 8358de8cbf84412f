// Errors of long trajectories: a million poses absolutely, a hundred thousand over all motions of a length.
#include <benchmark/benchmark.h>

#include <cmath>

#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"
#include "tests/bench/wandering_trajectory.hpp"

namespace fusebench {

using namespace trajectory_error;

namespace {

using testing::seen_from_elsewhere;
using testing::wandering;

void ate_with_association(benchmark::State& state) {
  const Trajectory truth = wandering(state.range(0));
  const Trajectory estimate = seen_from_elsewhere(truth, 0.01);
  TrajectoryRequest request = request_for(Protocol::evo, TrajectoryMetric::ate).value();
  request.alignment.mode = AlignmentMode::se3;
  const auto checked = evaluate(truth, estimate, request);
  if (!checked || checked->pairs != truth.size() || std::abs(checked->series[0].stats.rmse - 0.01) > 1e-6)
    return state.SkipWithError("the error is not what was put in");
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(truth, estimate, request));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void rpe_all_pairs(benchmark::State& state) {
  const Trajectory truth = wandering(state.range(0));
  const Trajectory estimate = seen_from_elsewhere(truth, 0.01);
  TrajectoryRequest request = request_for(Protocol::evo, TrajectoryMetric::rpe).value();
  request.motions = MotionRule::all;
  request.delta = {1, DeltaUnit::metres};
  request.from_reference = true;
  const auto checked = evaluate(truth, estimate, request);
  // Motions of an even number of steps have no error, of an odd number twice the amplitude.
  if (!checked || checked->series[0].errors.size() < truth.size() / 2 ||
      std::abs(checked->series[0].stats.max - 0.02) > 1e-9)
    return state.SkipWithError("the error is not what was put in");
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(truth, estimate, request));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(ate_with_association)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(rpe_all_pairs)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
