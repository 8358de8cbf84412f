// The scenes that a benchmark runs over, as its arguments.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "tests/bench/scene_kinds.hpp"

namespace fusebench::testing {

/// Every kind and width (pixels) of scene: the room at two sizes, and the recording if it is there.
[[nodiscard]] inline std::vector<std::pair<SceneKind, std::int64_t>> kinds_and_widths() {
  std::vector<std::pair<SceneKind, std::int64_t>> scenes = {{SceneKind::room, 320}, {SceneKind::room, 640}};
  if (recorded_folder()) scenes.emplace_back(SceneKind::recording, 640);
  return scenes;
}

/// Arguments: scene (0 = room, 1 = recording), width, and each of kThird (threads, for most).
template <std::int64_t... kThird>
void over_scenes(benchmark::internal::Benchmark* benchmark) {
  for (const auto& [kind, width_px] : kinds_and_widths()) {
    const auto scene = static_cast<std::int64_t>(kind);
    if constexpr (sizeof...(kThird) == 0) {
      benchmark->Args({scene, width_px});
    } else {
      for (const std::int64_t third : {kThird...}) benchmark->Args({scene, width_px, third});
    }
  }
}

/// The same with one and with two threads, in wall time, since that is what threads save.
inline void over_scenes_and_threads(benchmark::internal::Benchmark* benchmark) {
  over_scenes<1, 2>(benchmark);
  benchmark->ArgNames({"scene", "width", "workers"})->UseRealTime();
}

[[nodiscard]] inline const BenchScene& scene_of(const benchmark::State& state) {
  return bench_scene(static_cast<SceneKind>(state.range(0)), static_cast<int>(state.range(1)));
}
[[nodiscard]] inline Workers workers_of(const benchmark::State& state) {
  return Workers(static_cast<int>(state.range(2)));
}

}  // namespace fusebench::testing
