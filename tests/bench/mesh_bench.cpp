// A million vertices against a million triangles, exactly. Argument: triangles.
#include <benchmark/benchmark.h>

#include <cmath>
#include <thread>

#include "eval/metrics/mesh_error/mesh_metrics.hpp"
#include "tests/bench/rates.hpp"
#include "tests/support/test_meshes.hpp"

namespace fusebench {

using namespace metrics;
using namespace mesh_error;

namespace {

using testing::bytes_of;

constexpr double kOffset_m = 0.005;

/// At least so many; of 2 rings (rings + 1) vertices and 4 rings^2 triangles.
int rings_for(std::int64_t triangles) {
  return static_cast<int>(std::ceil(std::sqrt(static_cast<double>(triangles) / 4)));
}

double bytes_of_mesh(const PreciseMesh& mesh) {
  return bytes_of<Vector3d>(mesh.vertices.size()) +
         bytes_of<std::array<std::uint32_t, 3>>(mesh.triangles.size());
}

void mesh_accuracy(benchmark::State& state) {
  const PreciseMesh truth = testing::sphere(1, rings_for(state.range(0)));
  const PreciseMesh reconstruction = testing::sphere(1 + kOffset_m, rings_for(2 * state.range(0)));
  const Workers workers(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  const auto measured = [&] {
    return statistics(distances_m(reconstruction.vertices, {}, TriangleTree(truth, workers), workers));
  };
  const double edge_m = 3.2 / rings_for(state.range(0));
  const double sagitta_m = edge_m * edge_m / 4;  // by which a facet may lie below the sphere
  if (const Statistics stats = measured();
      stats.count < static_cast<std::size_t>(state.range(0)) || std::abs(stats.mean - kOffset_m) > sagitta_m)
    return state.SkipWithError("the distance is not what was put in");
  for (auto _ : state) benchmark::DoNotOptimize(measured());
  const std::size_t vertices = reconstruction.vertices.size();
  // Vertices and the other mesh in, distances out.
  testing::report_rates(state,
                        {"vertices", vertices,
                         bytes_of<Vector3d>(vertices) + bytes_of_mesh(truth) + bytes_of<double>(vertices)});
}

void mesh_tree(benchmark::State& state) {
  const PreciseMesh truth = testing::sphere(1, rings_for(state.range(0)));
  const Workers workers(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  if (TriangleTree(truth, workers).nearest({0, 0, 3}).squared_m2 != 4)
    return state.SkipWithError("the pole is elsewhere");
  for (auto _ : state) benchmark::DoNotOptimize(TriangleTree(truth, workers));
  // The mesh in; how large a tree has to be is not said.
  testing::report_rates(state, {"triangles", truth.triangles.size(), bytes_of_mesh(truth)});
}

BENCHMARK(mesh_accuracy)->Arg(10'000)->Arg(1'000'000)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(mesh_tree)->Arg(1'000'000)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
