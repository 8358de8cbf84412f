// Loading a frame: both images from disk, checked, decoded, undistorted.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>

#include "datasets/open_recording.hpp"

namespace fusebench {
namespace {

void load_frame(benchmark::State& state) {
  const auto recording =
      open_recording(std::filesystem::path(FUSEBENCH_GOLDEN) / "tum_freiburg1_rpy_5frames");
  if (!recording) return state.SkipWithError(recording.error().message.c_str());
  std::size_t frame = 0;
  const auto load = [&] { return recording->load_frame(frame++ % recording->frames.size()); };
  for (std::size_t i = 0; i < recording->frames.size(); ++i) {
    const auto loaded = load();
    if (!loaded) return state.SkipWithError(loaded.error().message.c_str());
    const auto& depth_m = loaded->depth_m.data;
    const auto measured = std::count_if(depth_m.begin(), depth_m.end(), [](float z) { return z > 0.0F; });
    if (loaded->timestamp_ns != recording->frames[i].timestamp_ns || loaded->color.width != 640 ||
        loaded->grey.data != to_grey(loaded->color).data || 2 * measured < std::ssize(depth_m)) {
      return state.SkipWithError("not the frame that was asked for");
    }
  }
  for (auto _ : state) benchmark::DoNotOptimize(load());
}

BENCHMARK(load_frame)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
