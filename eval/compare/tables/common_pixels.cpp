#include "eval/compare/tables/common_pixels.hpp"

#include <fmt/format.h>

#include "eval/metrics/intensity_file.hpp"

namespace fusebench::tables {

namespace {

tl::unexpected<Error> different(const metrics::IntensityReader& first, const metrics::IntensityReader& other,
                                std::string_view what) {
  return fail(ErrorCode::data_corrupt,
              fmt::format("{} and {} differ in their {}", first.file().string(), other.file().string(), what),
              "only runs of the same recording and frames can be compared");
}

Result<std::vector<metrics::IntensityReader>> open_all(std::span<const std::filesystem::path> files) {
  std::vector<metrics::IntensityReader> readers;
  for (const std::filesystem::path& file : files) {
    auto reader = metrics::IntensityReader::open(file);
    if (!reader) return tl::unexpected(reader.error());
    readers.push_back(std::move(*reader));
    if (readers.back().width_px() != readers.front().width_px() ||
        readers.back().height_px() != readers.front().height_px()) {
      return different(readers.front(), readers.back(), "image size");
    }
  }
  return readers;
}

/// The next frame of each; empty when all have ended.
Result<std::vector<metrics::IntensityFrame>> next_frames(std::vector<metrics::IntensityReader>& readers) {
  std::vector<metrics::IntensityFrame> frames;
  for (std::size_t i = 0; i < readers.size(); ++i) {
    auto frame = readers[i].next();
    if (!frame) return tl::unexpected(frame.error());
    if (i > 0 && frame->has_value() == frames.empty())
      return different(readers[0], readers[i], "number of frames");
    if (!*frame) continue;
    if (i > 0 && (*frame)->timestamp_ns != frames[0].timestamp_ns)
      return different(readers[0], readers[i], "stamps");
    frames.push_back(std::move(**frame));
  }
  return frames;
}

}  // namespace

Result<std::vector<metrics::IntensitySummary>> common_pixel_error(
    std::span<const std::filesystem::path> files) {
  auto readers = open_all(files);
  if (!readers) return tl::unexpected(readers.error());
  metrics::CommonIntensityAccumulator sums(files.size());
  for (bool first = true;; first = false) {
    auto frames = next_frames(*readers);
    if (!frames) return tl::unexpected(frames.error());
    if (frames->empty()) return sums.result();
    // The first frame of a run has no anchor, hence no pixels: it is not one that shares none.
    if (first) continue;
    std::vector<std::vector<IntensityResidual>> pixels;
    for (metrics::IntensityFrame& frame : *frames) pixels.push_back(std::move(frame.pixels));
    sums.add_frame(pixels);
  }
}

}  // namespace fusebench::tables
