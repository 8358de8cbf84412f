#include <cmath>
#include <optional>

#include "eval/metrics/mesh_error/mesh_metrics.hpp"
#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"
#include "tests/bench/wandering_trajectory.hpp"
#include "tests/perf/kernel_counts.hpp"
#include "tests/support/test_meshes.hpp"

namespace fusebench::perf {

using namespace metrics;
using namespace trajectory_error;
using namespace mesh_error;

namespace {

constexpr double kError_m = 0.01;

void count_absolute_errors(KernelCounts& counts, const Trajectory& truth, const Trajectory& estimate) {
  TrajectoryRequest request = request_for(Protocol::evo, TrajectoryMetric::ate).value();
  request.alignment.mode = AlignmentMode::se3;
  std::optional<Result<TrajectoryEvaluation>> result;
  counts.count(
      "ate", "pose", [&] { result = evaluate(truth, estimate, request); },
      [&] {
        check(result->has_value() && (*result)->pairs == truth.size() &&
                  std::abs((*result)->series[0].stats.rmse - kError_m) < 1e-6,
              "the error is what was put in");
        return truth.size();
      });
}

void count_relative_errors(KernelCounts& counts, const Trajectory& truth, const Trajectory& estimate) {
  TrajectoryRequest request = request_for(Protocol::evo, TrajectoryMetric::rpe).value();
  request.motions = MotionRule::all;
  request.delta = {1, DeltaUnit::metres};
  request.from_reference = true;
  std::optional<Result<TrajectoryEvaluation>> result;
  counts.count(
      "rpe_all_pairs", "pose", [&] { result = evaluate(truth, estimate, request); },
      [&] {
        // Motions of an even number of steps have no error, of an odd number twice the amplitude.
        check(result->has_value() && std::abs((*result)->series[0].stats.max - 2 * kError_m) < 1e-9,
              "the error is what was put in");
        return truth.size();
      });
}

/// Vertices of a sphere against the triangles of a smaller one.
void count_mesh_distances(KernelCounts& counts) {
  constexpr int kRings = 50;  // 10'000 triangles
  constexpr double kOffset_m = 0.005;
  const Workers workers(1);
  const PreciseMesh truth = testing::sphere(1, kRings);
  const PreciseMesh reconstruction = testing::sphere(1 + kOffset_m, kRings);
  Statistics stats;
  counts.count(
      "mesh_distances", "vertex",
      [&] {
        stats = statistics(distances_m(reconstruction.vertices, {}, TriangleTree(truth, workers), workers));
      },
      [&] {
        check(std::abs(stats.mean - kOffset_m) < 1e-3, "the distance is what was put in");
        return stats.count;
      });
}

}  // namespace

void count_evaluation_kernels(KernelCounts& counts) {
  const Trajectory truth = testing::wandering(10'000);
  const Trajectory estimate = testing::seen_from_elsewhere(truth, kError_m);
  count_absolute_errors(counts, truth, estimate);
  count_relative_errors(counts, truth, estimate);
  count_mesh_distances(counts);
}

}  // namespace fusebench::perf
