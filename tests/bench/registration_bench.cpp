// Registration of depth to colour: its time, and as counters what it does to the depth and what the
// alternatives would do (docs/datasets.md has the table).
#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>

#include "datasets/calibration/depth_registration.hpp"
#include "tests/bench/rates.hpp"
#include "tests/support/two_cameras.hpp"

namespace fusebench {

using namespace calibration;

namespace {

using testing::RegistrationQuality;
using testing::TexturedRoom;
using testing::TwoCameras;

using Registration = std::function<DepthImage(const DepthImage&)>;

/// What the depth camera's files say of the room: whole millimetres.
DepthImage measured_depth(const TexturedRoom& room, const TwoCameras& cameras, const SE3& T_world_depth) {
  DepthImage depth_m = testing::exact_depth(room, cameras.depth, T_world_depth);
  for (float& z : depth_m.data) z = 0.001F * std::round(1000.0F * z);
  return depth_m;
}

double percent(std::size_t part, std::size_t whole) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void measure(benchmark::State& state, const Registration& to_color) {
  const TwoCameras cameras;
  const TexturedRoom room;
  RegistrationQuality quality;
  for (const SE3& T_world_depth : testing::registration_views())
    quality.add(room, cameras, T_world_depth, to_color(measured_depth(room, cameras, T_world_depth)));
  state.counters["with_depth_%"] = percent(quality.with_depth, quality.pixels);
  state.counters["missed_%"] = percent(quality.missed, quality.seen_by_both);
  state.counters["too_near_%"] = percent(quality.too_near, quality.with_depth);
  state.counters["too_far_%"] = percent(quality.too_far, quality.with_depth);
  state.counters["median_mm"] = 1e3 * quality.error_quantile_m(0.5);
  state.counters["p95_mm"] = 1e3 * quality.error_quantile_m(0.95);
  if (quality.with_depth < quality.pixels / 2) return state.SkipWithError("most of the depth is lost");
  const DepthImage depth_m = measured_depth(room, cameras, testing::registration_views().front());
  for (auto _ : state) benchmark::DoNotOptimize(to_color(depth_m));
  // Depth in and out.
  const std::size_t pixels = depth_m.data.size();
  testing::report_rates(state, {"pixels", pixels, testing::bytes_of<float>(2 * pixels)});
}

void register_depth(benchmark::State& state) {
  const TwoCameras cameras;
  const DepthRegistration registration(cameras.depth, cameras.color, cameras.T_color_depth);
  measure(state, [&](const DepthImage& depth_m) { return registration.register_depth(depth_m); });
}

/// For comparison: every measurement goes into the one pixel that is nearest to it.
void register_depth_one_pixel_each(benchmark::State& state) {
  const TwoCameras cameras;
  measure(state, [&](const DepthImage& depth_m) {
    DepthImage registered_m(cameras.color.width_px, cameras.color.height_px);
    for (int y = 0; y < depth_m.height; ++y) {
      for (int x = 0; x < depth_m.width; ++x) {
        const Vector3d point = cameras.T_color_depth * cameras.depth.back_project(x, y, depth_m(x, y));
        const Vector2d at = cameras.color.project(point);
        const auto u = static_cast<int>(std::lround(at.x()));
        const auto v = static_cast<int>(std::lround(at.y()));
        if (!registered_m.contains(u, v)) continue;
        float& kept_m = registered_m(u, v);
        if (kept_m == 0 || point.z() < kept_m) kept_m = static_cast<float>(point.z());
      }
    }
    return registered_m;
  });
}

/// The other way: depth stays where it is, and each measurement takes its colour from where it lands. The
/// colour is another surface's where the colour camera does not see the measurement; a z-test against
/// registered depth finds most of these.
void color_by_projection(benchmark::State& state) {
  const TwoCameras cameras;
  const TexturedRoom room;
  const DepthRegistration registration(cameras.depth, cameras.color, cameras.T_color_depth);
  std::size_t measurements = 0, outside = 0, wrong = 0, wrong_after_test = 0, right_refused = 0;
  for (const SE3& T_world_depth : testing::registration_views()) {
    const SE3 T_world_color = T_world_depth * cameras.T_color_depth.inverse();
    const DepthImage depth_m = measured_depth(room, cameras, T_world_depth);
    const DepthImage registered_m = registration.register_depth(depth_m);
    for (int y = 0; y < depth_m.height; ++y) {
      for (int x = 0; x < depth_m.width; ++x) {
        const Vector3d point = cameras.T_color_depth * cameras.depth.back_project(x, y, depth_m(x, y));
        const Vector2d at = cameras.color.project(point);
        const auto u = static_cast<int>(std::lround(at.x()));
        const auto v = static_cast<int>(std::lround(at.y()));
        ++measurements;
        if (!registered_m.contains(u, v)) {
          ++outside;
          continue;
        }
        const double seen_m = testing::exact_depth_m(room, cameras.color, T_world_color, at.x(), at.y());
        const bool hidden = point.z() > seen_m + RegistrationQuality::kWrongSurface_m;
        const bool refused = point.z() > registered_m(u, v) + RegistrationQuality::kWrongSurface_m;
        wrong += hidden ? 1 : 0;
        wrong_after_test += hidden && !refused ? 1 : 0;
        right_refused += !hidden && refused ? 1 : 0;
      }
    }
  }
  state.counters["outside_%"] = percent(outside, measurements);
  state.counters["wrong_color_%"] = percent(wrong, measurements);
  state.counters["wrong_after_z_test_%"] = percent(wrong_after_test, measurements);
  state.counters["right_refused_%"] = percent(right_refused, measurements);
  for (auto _ : state) benchmark::DoNotOptimize(measurements);
}

BENCHMARK(register_depth)->Unit(benchmark::kMillisecond);
BENCHMARK(register_depth_one_pixel_each)->Unit(benchmark::kMillisecond);
BENCHMARK(color_by_projection)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
