#include "eval/compare/study/shared_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

#include "core/base/io/bounded_text.hpp"
#include "core/base/io/input_file.hpp"
#include "core/base/io/text_table.hpp"
#include "eval/metrics/intensity_file.hpp"

namespace fusebench::study {

namespace {

/// Differences by pixel; the first of a pixel counts, where patches overlap.
class PixelMap {
 public:
  explicit PixelMap(std::size_t pixels) : marks_(pixels, 0), differences_(pixels, 0.0F) {}

  void fill(const std::vector<IntensityResidual>& pixels) {
    ++mark_;
    for (const IntensityResidual& pixel : pixels) {
      if (marks_[pixel.pixel] == mark_) continue;
      marks_[pixel.pixel] = mark_;
      differences_[pixel.pixel] = pixel.difference_grey;
    }
  }
  [[nodiscard]] bool has(std::uint32_t pixel) const { return marks_[pixel] == mark_; }
  [[nodiscard]] double difference(std::uint32_t pixel) const {
    return static_cast<double>(differences_[pixel]);
  }

 private:
  std::vector<std::uint32_t> marks_;  // of the fill that wrote a pixel, so that nothing has to be cleared
  std::vector<float> differences_;
  std::uint32_t mark_ = 0;
};

SharedFrame shared_frame(const metrics::IntensityFrame& reference, PixelMap& reference_map,
                         const metrics::IntensityFrame& variant, PixelMap& variant_map) {
  reference_map.fill(reference.pixels);
  variant_map.fill(variant.pixels);
  SharedFrame frame;
  frame.timestamp_ns = reference.timestamp_ns;
  std::vector<std::uint32_t> pixels;
  for (const IntensityResidual& pixel : variant.pixels) {
    if (reference_map.has(pixel.pixel)) pixels.push_back(pixel.pixel);
  }
  std::sort(pixels.begin(), pixels.end());
  pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
  for (const std::uint32_t pixel : pixels) {
    frame.reference_grey += reference_map.difference(pixel);
    frame.variant_grey += variant_map.difference(pixel);
  }
  frame.pixels = pixels.size();
  if (pixels.empty()) return frame;
  frame.reference_grey /= static_cast<double>(pixels.size());
  frame.variant_grey /= static_cast<double>(pixels.size());
  return frame;
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

Result<std::vector<SharedFrame>> shared_frames(const std::filesystem::path& reference_file,
                                               const std::filesystem::path& variant_file) {
  auto reference = metrics::IntensityReader::open(reference_file);
  if (!reference) return tl::unexpected(reference.error());
  auto variant = metrics::IntensityReader::open(variant_file);
  if (!variant) return tl::unexpected(variant.error());
  const auto different = [&](std::string_view what) {
    return fail(ErrorCode::data_corrupt, fmt::format("{} and {} differ in their {}", reference_file.string(),
                                                     variant_file.string(), what));
  };
  if (reference->width_px() != variant->width_px() || reference->height_px() != variant->height_px())
    return different("image size");
  const std::size_t pixels = std::size_t{reference->width_px()} * reference->height_px();
  PixelMap reference_map(pixels);
  PixelMap variant_map(pixels);
  std::vector<SharedFrame> frames;
  while (true) {
    const auto left = reference->next();
    if (!left) return tl::unexpected(left.error());
    const auto right = variant->next();
    if (!right) return tl::unexpected(right.error());
    if (left->has_value() != right->has_value()) return different("number of frames");
    if (!left->has_value()) return frames;
    if ((*left)->timestamp_ns != (*right)->timestamp_ns) return different("stamps");
    const SharedFrame frame = shared_frame(**left, reference_map, **right, variant_map);
    if (frame.pixels > 0) frames.push_back(frame);
  }
}

Result<std::map<std::int64_t, double>> read_patch_motion(const std::filesystem::path& frames_csv) {
  std::ifstream stream = io::input_file(frames_csv);
  std::string line;
  if (!stream || !io::next_line(stream, line))
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be read", frames_csv.string()));
  const std::string header_line = line;
  const std::vector<std::string_view> header = cells_of(header_line);
  const auto column = [&](std::string_view name) {
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
  };
  const std::size_t stamp = column("timestamp");
  const std::size_t motion = column("patch_motion_px");
  const auto corrupt = [&](int number, std::string_view what) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}:{}: {}", frames_csv.string(), number, what));
  };
  if (std::max(stamp, motion) >= header.size())
    return corrupt(1, "has no columns timestamp and patch_motion_px");
  std::map<std::int64_t, double> result;
  for (int number = 2; io::next_line(stream, line); ++number) {
    const std::vector<std::string_view> cells = cells_of(line);
    if (cells.size() != header.size())
      return corrupt(number, "has another number of columns than the header");
    if (cells[motion].empty()) continue;
    const auto time = io::parse_time_ns(cells[stamp]);
    if (!time) return corrupt(number, time.error().message);
    const auto pixels = io::parse_number(cells[motion]);
    if (!pixels) return corrupt(number, pixels.error().message);
    result[*time] = *pixels;
  }
  return result;
}

SharedMeans shared_means(std::span<const SharedFrame> frames) {
  SharedMeans means;
  for (const SharedFrame& frame : frames) {
    ++means.frames;
    means.pixels += frame.pixels;
    means.reference_grey += frame.reference_grey;
    means.variant_grey += frame.variant_grey;
  }
  if (means.frames == 0) return means;
  means.reference_grey /= static_cast<double>(means.frames);
  means.variant_grey /= static_cast<double>(means.frames);
  return means;
}

}  // namespace fusebench::study
