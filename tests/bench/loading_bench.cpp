// Loading a frame: both images from disk, checked, decoded, undistorted; and the decoding alone.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/io/fingerprint.hpp"
#include "datasets/open_recording.hpp"
#include "tests/bench/golden_frames.hpp"
#include "tests/bench/rates.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace io;
using namespace images;
using namespace recording;
using namespace datasets;

namespace {

using testing::bytes_of;
using testing::golden_folder;
using testing::ImagePair;
using testing::ImagePairFiles;

double size_of(const std::filesystem::path& file) {
  return static_cast<double>(std::filesystem::file_size(file));
}

void load_frame(benchmark::State& state) {
  const auto recording = open_recording(golden_folder());
  if (!recording) return state.SkipWithError(recording.error().message.c_str());
  std::size_t frame = 0;
  const auto load = [&] { return recording->load_frame(frame++ % recording->frames.size()); };
  std::size_t pixels = 0;
  double file_bytes = 0;
  for (const FrameEntry& entry : recording->frames) {
    const auto loaded = load();
    if (!loaded) return state.SkipWithError(loaded.error().message.c_str());
    const auto& depth_m = loaded->depth_m.data;
    const auto measured = std::count_if(depth_m.begin(), depth_m.end(), [](float z) { return z > 0.0F; });
    if (loaded->timestamp_ns != entry.timestamp_ns || loaded->color.width != 640 ||
        loaded->grey.data != to_grey(loaded->color).data || 2 * measured < std::ssize(depth_m)) {
      return state.SkipWithError("not the frame that was asked for");
    }
    pixels = depth_m.size();
    file_bytes += size_of(entry.color_file) + size_of(entry.depth_file);
  }
  for (auto _ : state) benchmark::DoNotOptimize(load());
  // Files in; colour, grey and depth out.
  testing::report_rates(state,
                        {"pixels", pixels,
                         file_bytes / static_cast<double>(recording->frames.size()) + bytes_of<Rgb>(pixels) +
                             bytes_of<std::uint8_t>(pixels) + bytes_of<float>(pixels)});
}

void decode_pair(benchmark::State& state, const ImagePairFiles& files, std::size_t pixels) {
  for (auto _ : state) benchmark::DoNotOptimize(testing::read_pair(files));
  // Files in; pixels of both images out.
  testing::report_rates(state, {"pixels", pixels,
                                size_of(files.color) + size_of(files.depth) + bytes_of<Rgb>(pixels) +
                                    bytes_of<std::uint16_t>(pixels)});
}

/// As a sensor's files are.
void decode_png_pair(benchmark::State& state) {
  const ImagePairFiles files = testing::golden_pair_files();
  const auto pair = testing::read_pair(files);
  if (!pair || !testing::is_golden_pair(*pair)) return state.SkipWithError("these are not the images");
  decode_pair(state, files, pair->depth.data.size());
}

ImagePair rendered_pair(int width_px) {
  const double focal_px = 0.75 * width_px;
  const PinholeCamera camera{width_px, width_px * 3 / 4, focal_px,
                             focal_px, 0.5 * width_px,   0.375 * width_px};
  const RgbdFrame frame = testing::TexturedRoom{}.render(camera, SE3{}, 0);
  ImagePair pair{frame.color, Image<std::uint16_t>(camera.width_px, camera.height_px)};
  std::ranges::transform(frame.depth_m.data, pair.depth.data.begin(),
                         [](float z) { return static_cast<std::uint16_t>(std::lround(5000.0F * z)); });
  return pair;
}

/// Of the room, at any size: what is read is what was written. Argument: width (pixels).
void decode_rendered_png_pair(benchmark::State& state) {
  const ImagePair written = rendered_pair(static_cast<int>(state.range(0)));
  const testing::TemporaryFolder folder;
  const ImagePairFiles files{folder.path() / "color.png", folder.path() / "depth.png"};
  if (!write_png(files.color, written.color) || !write_png(files.depth, written.depth))
    return state.SkipWithError("the images cannot be written");
  const auto read = testing::read_pair(files);
  if (!read || read->color.data != written.color.data || read->depth.data != written.depth.data)
    return state.SkipWithError("what is read is not what was written");
  decode_pair(state, files, written.depth.data.size());
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
  double bytes = 0;
  std::size_t pixels = 0;
  for (const std::filesystem::path& file : files) {
    const auto image = read(file, std::nullopt, std::nullopt);
    if (!image) return state.SkipWithError(image.error().message.c_str());
    const auto& data = image->data;
    pixels_read.add({reinterpret_cast<const char*>(data.data()), data.size() * sizeof(data.front())});
    pixels = data.size();
    bytes += size_of(file) + static_cast<double>(sizeof(data.front()) * data.size());
  }
  if (pixels_read.hex() != pixels_hash) return state.SkipWithError("not the pixels of these files");
  std::size_t reads = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(read(files[reads++ % files.size()], std::nullopt, std::nullopt));
  // The file in, the pixels out; the mean of the files.
  testing::report_rates(state, {"pixels", pixels, bytes / static_cast<double>(files.size())});
}

void read_color_png(benchmark::State& state) {
  read_images(state, "rgb", "6127e3972b2c960b75d0959d814d800a", read_color);
}

void read_depth_png(benchmark::State& state) {
  read_images(state, "depth", "f6ec8913f4e36539f354f7ee9622b65c", read_depth16);
}

BENCHMARK(load_frame)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_png_pair)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_rendered_png_pair)
    ->ArgName("width")
    ->Arg(320)
    ->Arg(640)
    ->Arg(1280)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(read_color_png)->Unit(benchmark::kMillisecond);
BENCHMARK(read_depth_png)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
