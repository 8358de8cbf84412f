// Errors of long trajectories: a million poses absolutely, a hundred thousand over all motions of a length.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>

#include "eval/trajectory/evaluation.hpp"

namespace fusebench {
namespace {

constexpr std::int64_t kStep_ns = 10'000'000;

/// A wandering camera with a pose every 10 ms.
Trajectory wandering(std::int64_t poses) {
  Trajectory trajectory;
  trajectory.reserve(static_cast<std::size_t>(poses));
  for (std::int64_t i = 0; i < poses; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    trajectory.push_back({1'305'031'100'000'000'000 + i * kStep_ns,
                          {so3_exp(Vector3d(0.3 * std::sin(t), 0.2 * std::cos(2 * t), 0.1 * t)),
                           Vector3d(5 * std::sin(t), 3 * std::sin(1.7 * t), std::cos(2.3 * t))}});
  }
  return trajectory;
}

/// In another world and a quarter step later, with an error along y whose amplitude is error_m.
Trajectory seen_from_elsewhere(const Trajectory& truth, double error_m) {
  const SE3 T_other_world{so3_exp(Vector3d(0.4, -1.0, 2.0)), Vector3d(1, -2, 3)};
  Trajectory estimate = truth;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    estimate[i].timestamp_ns += kStep_ns / 4;
    SE3& pose = estimate[i].T_world_camera;
    pose.translation.y() += i % 2 == 0 ? error_m : -error_m;
    pose = T_other_world * pose;
  }
  return estimate;
}

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
