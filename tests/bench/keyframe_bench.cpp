// Places seen before: keeping a frame, and finding a frame's place among those kept.
#include <benchmark/benchmark.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/config/config.hpp"
#include "core/estimator/places/relocalisation/keyframes.hpp"
#include "tests/bench/bench_scene.hpp"
#include "tests/bench/rates.hpp"
#include "tests/bench/scene_arguments.hpp"

namespace fusebench {

using namespace simd;
using namespace relocalisation;

namespace {

using testing::BenchScene;
using testing::bytes_of;

constexpr config::Config kDefaults{};

/// Every view is kept, however near it is to another.
constexpr config::Config dense() {
  config::Config config;
  config.relocalisation.keyframe_distance_m = 1e-6;
  config.relocalisation.keyframe_angle_deg = 1e-4;
  return config;
}
constexpr config::Config kDense = dense();

void keyframe_offer(benchmark::State& state) {
  const BenchScene& scene = testing::scene_of(state);
  const testing::FusedView& view = scene.views.back();
  const auto keep = [&] {
    Keyframes keyframes(scene.camera, kDefaults);
    const bool kept = keyframes.offer(view.grey, view.depth_m, view.T_world_camera, 0);
    return kept ? std::optional(std::move(keyframes)) : std::nullopt;
  };
  auto keyframes = keep();
  const auto found = keyframes ? keyframes->find(view.grey) : std::nullopt;
  if (!found || (found->T_world_camera.translation - view.T_world_camera.translation).norm() > 1e-3)
    return state.SkipWithError("the frame does not find its own place");
  for (auto _ : state) benchmark::DoNotOptimize(keep());
  // Grey levels and depth in, a copy of the grey levels out; the copy of the depth may be smaller.
  const std::size_t pixels = view.grey.data.size();
  testing::report_rates(state,
                        {"pixels", pixels, bytes_of<std::uint8_t>(2 * pixels) + bytes_of<float>(pixels)});
}

void keyframe_landmarks(benchmark::State& state) {
  const BenchScene& scene = testing::scene_of(state);
  const testing::FusedView& view = scene.views.back();
  // They have the depth that the frame has there.
  const Landmarks landmarks =
      landmarks_of(view.grey, view.depth_m, scene.camera, kDefaults.place_features, kDefaults.relocalisation);
  for (std::size_t i = 0; i < landmarks.features.size(); ++i) {
    const Vector2d& pixel_px = landmarks.features[i].pixel_px;
    const double depth_m = static_cast<double>(view.depth_m(static_cast<int>(std::lround(pixel_px.x())),
                                                            static_cast<int>(std::lround(pixel_px.y()))));
    const Vector3d expected = scene.camera.back_project(pixel_px.x(), pixel_px.y(), depth_m);
    if (!(depth_m > 0) || (landmarks.points_camera[i] - expected).norm() > 1e-3)
      return state.SkipWithError("features are not where the frame has them");
  }
  if (landmarks.features.size() < 100) return state.SkipWithError("the frame has few landmarks");
  for (auto _ : state)
    benchmark::DoNotOptimize(landmarks_of(view.grey, view.depth_m, scene.camera, kDefaults.place_features,
                                          kDefaults.relocalisation));
  const std::size_t pixels = view.grey.data.size();
  testing::report_rates(state, {"pixels", pixels, bytes_of<std::uint8_t>(pixels)});
  state.counters["features"] = static_cast<double>(landmarks.features.size());
}

void keyframe_find(benchmark::State& state) {
  const BenchScene& scene = testing::scene_of(state);
  const auto count = static_cast<std::size_t>(state.range(2));
  Keyframes keyframes(scene.camera, kDense);
  for (std::size_t i = scene.views.size() - count; i < scene.views.size(); ++i) {
    const testing::FusedView& view = scene.views[i];
    if (!keyframes.offer(view.grey, view.depth_m, view.T_world_camera, static_cast<std::int64_t>(i)))
      return state.SkipWithError("a view is not kept");
  }
  const std::vector<FoundPlace> found = keyframes.find(scene.frame.grey);
  // The ground truth of a recording is good to a centimetre or two.
  if (found.empty() ||
      (found.front().T_world_camera.translation - scene.T_world_camera.translation).norm() > 0.05 ||
      rotation_angle_rad(found.front().T_world_camera.rotation, scene.T_world_camera.rotation) > radians(2)) {
    return state.SkipWithError("the place is not found");
  }
  std::size_t features = 0;
  for (std::size_t i = 0; i < keyframes.size(); ++i) features += keyframes[i].landmarks->features.size();
  for (auto _ : state) benchmark::DoNotOptimize(keyframes.find(scene.frame.grey));
  // The image and all descriptors in.
  const std::size_t pixels = scene.frame.grey.data.size();
  testing::report_rates(
      state, {"pixels", pixels, bytes_of<std::uint8_t>(pixels) + bytes_of<OrbDescriptor>(features)});
  state.counters["keyframes"] = static_cast<double>(keyframes.size());
}

/// Up to as many keyframes as there are views.
void over_keyframes(benchmark::internal::Benchmark* benchmark) {
  for (const auto& [kind, width_px] : testing::kinds_and_widths()) {
    const std::vector<std::int64_t> counts = kind == testing::SceneKind::room
                                                 ? std::vector<std::int64_t>{1, 3}
                                                 : std::vector<std::int64_t>{1, 3, 10, 30};
    for (const std::int64_t count : counts)
      benchmark->Args({static_cast<std::int64_t>(kind), width_px, count});
  }
  benchmark->ArgNames({"scene", "width", "keyframes"});
}

BENCHMARK(keyframe_offer)
    ->Apply(testing::over_scenes<>)
    ->ArgNames({"scene", "width"})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(keyframe_landmarks)
    ->Apply(testing::over_scenes<>)
    ->ArgNames({"scene", "width"})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(keyframe_find)->Apply(over_keyframes)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
