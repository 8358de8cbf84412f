// What happens to a frame before it is tracked: motion compensation, pyramid, depth gates.
#include <benchmark/benchmark.h>

#include "core/estimator/preprocessing/depth_gates.hpp"
#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"
#include "tests/bench/bench_scene.hpp"
#include "tests/bench/frame_answers.hpp"
#include "tests/bench/rates.hpp"
#include "tests/bench/scene_arguments.hpp"

namespace fusebench {

using namespace preprocessing;

namespace {

using testing::BenchScene;
using testing::bytes_of;
using testing::over_scenes;
using testing::scene_of;

void motion_compensation(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = testing::workers_of(state);
  RgbdFrame frame;
  const auto compensate = [&] {
    compensate_motion(scene.sensed, scene.camera, scene.frame_timing(), scene.velocity, workers, frame);
  };
  compensate();
  if (!testing::is_compensated(frame, scene)) return state.SkipWithError("not what the plain search finds");
  if (scene.kind == testing::SceneKind::room && !testing::is_as_rendered(frame, scene))
    return state.SkipWithError("the rolling shutter is not compensated");
  for (auto _ : state) compensate();
  const std::size_t pixels = frame.grey.data.size();
  // Grey and depth in, the same out.
  const double frame_bytes = bytes_of<std::uint8_t>(pixels) + bytes_of<float>(pixels);
  testing::report_rates(state, {"pixels", pixels, 2 * frame_bytes});
}

void color_compensation(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const Workers workers = testing::workers_of(state);
  ColorImage color;
  const auto compensate = [&] {
    compensate_color(scene.sensed, scene.camera, scene.frame_timing(), scene.velocity, scene.ungated_depth_m,
                     workers, color);
  };
  compensate();
  if (!testing::is_color_compensated(color, scene.ungated_depth_m, scene))
    return state.SkipWithError("not what the plain search finds");
  for (auto _ : state) compensate();
  const std::size_t pixels = color.data.size();
  // Colour and depth in, colour out.
  testing::report_rates(state, {"pixels", pixels, 2 * bytes_of<Rgb>(pixels) + bytes_of<float>(pixels)});
}

void pyramid(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  const auto levels = static_cast<int>(state.range(2));
  std::vector<GreyImage> pyramid;
  const auto build = [&] { build_pyramid(scene.frame.grey, levels, pyramid); };
  build();
  if (!testing::is_pyramid_of(pyramid, scene.frame.grey))
    return state.SkipWithError("differs from the plain filter");
  for (auto _ : state) build();
  const std::size_t pixels = scene.frame.grey.data.size();
  std::size_t written = 0;
  for (const GreyImage& level : pyramid) written += level.data.size();
  // The image in, all levels out, level 0 being a copy.
  testing::report_rates(state, {"pixels", pixels, bytes_of<std::uint8_t>(pixels + written)});
}

void depth_gate(benchmark::State& state) {
  const BenchScene& scene = scene_of(state);
  DepthImage gated_m;
  const auto gate = [&] { gate_depth(scene.ungated_depth_m, scene.config.depth, gated_m); };
  gate();
  if (!testing::is_gated(gated_m, scene.ungated_depth_m, scene.config.depth))
    return state.SkipWithError("not the gates, pixel by pixel");
  for (auto _ : state) gate();
  const std::size_t pixels = gated_m.data.size();
  // Depth in and out.
  testing::report_rates(state, {"pixels", pixels, bytes_of<float>(2 * pixels)});
}

BENCHMARK(motion_compensation)->Apply(testing::over_scenes_and_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(color_compensation)->Apply(testing::over_scenes_and_threads)->Unit(benchmark::kMillisecond);
BENCHMARK(pyramid)
    ->Apply(over_scenes<3, 5>)
    ->ArgNames({"scene", "width", "levels"})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(depth_gate)->Apply(over_scenes<>)->ArgNames({"scene", "width"})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
