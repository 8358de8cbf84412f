// Loading a frame: both images from disk, checked, decoded, undistorted; and the decoding alone.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/fingerprint.hpp"
#include "datasets/image_files.hpp"
#include "datasets/open_recording.hpp"

namespace fusebench {
namespace {

std::filesystem::path golden_folder() {
  return std::filesystem::path(FUSEBENCH_GOLDEN) / "tum_freiburg1_rpy_5frames";
}

/// bytes: of the files that were read.
void count_work(benchmark::State& state, std::uintmax_t bytes, std::size_t pixels) {
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
  state.counters["pixels_per_second"] =
      benchmark::Counter(static_cast<double>(pixels), benchmark::Counter::kIsRate);
}

void load_frame(benchmark::State& state) {
  const auto recording = open_recording(golden_folder());
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
  std::uintmax_t bytes_of_all = 0;
  for (const FrameEntry& entry : recording->frames)
    bytes_of_all +=
        std::filesystem::file_size(entry.color_file) + std::filesystem::file_size(entry.depth_file);
  frame = 0;
  std::size_t pixels = 0;
  for (auto _ : state) {
    const auto loaded = load();
    pixels += loaded->color.data.size() + loaded->depth_m.data.size();
  }
  count_work(state, bytes_of_all * frame / recording->frames.size(), pixels);
}

/// pixels_hash: of all images of the folder in the order of their names, as OpenImageIO and OpenCV decode
/// them.
template <class Read>
void read_images(benchmark::State& state, std::string_view folder, std::string_view pixels_hash,
                 const Read& read) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(golden_folder() / folder))
    files.push_back(entry.path());
  std::ranges::sort(files);
  Fingerprint pixels_read;
  std::uintmax_t bytes_of_all = 0;
  for (const std::filesystem::path& file : files) {
    const auto image = read(file, std::nullopt);
    if (!image) return state.SkipWithError(image.error().message.c_str());
    const auto& data = image->data;
    pixels_read.add({reinterpret_cast<const char*>(data.data()), data.size() * sizeof(data.front())});
    bytes_of_all += std::filesystem::file_size(file);
  }
  if (pixels_read.hex() != pixels_hash) return state.SkipWithError("not the pixels of these files");
  std::size_t reads = 0;
  std::size_t pixels = 0;
  for (auto _ : state) pixels += read(files[reads++ % files.size()], std::nullopt)->data.size();
  count_work(state, bytes_of_all * reads / files.size(), pixels);
}

void read_color_png(benchmark::State& state) {
  read_images(state, "rgb", "6127e3972b2c960b75d0959d814d800a", read_color);
}

void read_depth_png(benchmark::State& state) {
  read_images(state, "depth", "f6ec8913f4e36539f354f7ee9622b65c", read_depth16);
}

BENCHMARK(load_frame)->Unit(benchmark::kMillisecond);
BENCHMARK(read_color_png)->Unit(benchmark::kMillisecond);
BENCHMARK(read_depth_png)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
