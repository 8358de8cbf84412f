#include "eval/record/run_files/patch_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/base/io/stamped_rows.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/images/image_files.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::run_files {

namespace {

constexpr std::size_t kFrames = 3;  // so that two variants have one in common
constexpr std::string_view kColumns =
    "frame timestamp motion_px patch accepted u v x y reference_grey observed_grey";

std::filesystem::path image_file(const std::filesystem::path& folder, std::size_t frame) {
  return folder / fmt::format("patches_{}.png", frame);
}

PatchTableFrame taken(std::size_t frame, const health::FrameReport& report, const GreyImage& grey) {
  PatchTableFrame result{frame, report.timestamp_ns, report.patch_motion_px, {}, grey};
  for (std::size_t i = 0; i < report.pixels.intensity.size(); ++i) {
    const IntensityResidual& residual = report.pixels.intensity[i];
    const WarpedPixel& landing = report.pixels.warped[i];
    const auto width = static_cast<std::uint32_t>(grey.width);
    result.pixels.push_back({landing.patch,
                             residual.accepted,
                             {static_cast<int>(landing.reference_pixel % width),
                              static_cast<int>(landing.reference_pixel / width)},
                             landing.warped_px,
                             landing.reference_grey,
                             landing.observed_grey});
  }
  return result;
}

}  // namespace

void FastestFrames::offer(std::size_t frame, const health::FrameReport& report, const GreyImage& grey) {
  if (report.status != health::FrameStatus::tracked || report.pixels.intensity.empty()) return;
  const auto slowest = std::ranges::min_element(frames_, {}, &PatchTableFrame::motion_px);
  if (frames_.size() == kFrames) {
    if (report.patch_motion_px <= slowest->motion_px) return;
    frames_.erase(slowest);
  }
  frames_.push_back(taken(frame, report, grey));  // so they stay in order
}

Result<void> write_patch_table(const std::filesystem::path& folder,
                               const std::vector<PatchTableFrame>& frames) {
  if (frames.empty()) return {};
  std::string text(kColumns);
  std::ranges::replace(text, ' ', ',');
  text.insert(0, "# ");
  text += '\n';
  for (const PatchTableFrame& frame : frames) {
    const std::string stamp = trajectory::stamp_text(frame.timestamp_ns);
    for (const PatchTablePixel& p : frame.pixels) {
      fmt::format_to(std::back_inserter(text), "{},{},{:.3f},{},{},{},{},{:.3f},{:.3f},{:.2f},{:.2f}\n",
                     frame.frame, stamp, frame.motion_px, p.patch, p.accepted ? 1 : 0, p.reference_px.x(),
                     p.reference_px.y(), p.warped_px.x(), p.warped_px.y(), p.reference_grey, p.observed_grey);
    }
    if (auto written = images::write_png(image_file(folder, frame.frame), frame.grey); !written)
      return written;
  }
  return text::write_text_file(folder / "patches.csv", text);
}

Result<std::vector<PatchTableFrame>> read_patch_table(const std::filesystem::path& folder) {
  std::vector<PatchTableFrame> frames;
  if (std::error_code ignored; !std::filesystem::exists(folder / "patches.csv", ignored)) return frames;
  const Result<void> done =
      io::for_each_row(folder / "patches.csv", kColumns, [&](const io::TextTable& table) -> Result<void> {
        std::array<double, 9> v{};
        const Result<double> frame = table.number(0);
        const Result<std::int64_t> stamp_ns = table.time_ns(1);
        if (!frame) return tl::unexpected(frame.error());
        if (!stamp_ns) return tl::unexpected(stamp_ns.error());
        if (auto read = table.numbers(2, v); !read) return read;
        constexpr double kMost = 1e6;  // of numbers of frames, patches and pixels
        const bool sound = *frame >= 0 && *frame < kMost && v[1] >= 0 &&
                           std::ranges::all_of(v, [](double value) { return std::abs(value) < kMost; });
        if (!sound) return table.fail_here("a number beyond any image");
        const auto number = static_cast<std::size_t>(*frame);
        if (frames.empty() || frames.back().frame != number)
          frames.push_back({number, *stamp_ns, v[0], {}, {}});
        frames.back().pixels.push_back({static_cast<std::uint32_t>(v[1]),
                                        v[2] != 0,
                                        {static_cast<int>(v[3]), static_cast<int>(v[4])},
                                        Vector2d(v[5], v[6]).cast<float>(),
                                        static_cast<float>(v[7]),
                                        static_cast<float>(v[8])});
        return {};
      });
  if (!done) return tl::unexpected(done.error());
  for (PatchTableFrame& frame : frames) {
    auto image = images::read_grey(image_file(folder, frame.frame));
    if (!image) return tl::unexpected(image.error());
    const auto inside = [&](const PatchTablePixel& p) {
      return image->contains(p.reference_px.x(), p.reference_px.y()) &&
             image->contains(static_cast<int>(p.warped_px.x()), static_cast<int>(p.warped_px.y()));
    };
    if (!std::ranges::all_of(frame.pixels, inside)) {
      return fail(ErrorCode::data_corrupt, fmt::format("{}: frame {} has a patch outside its image",
                                                       (folder / "patches.csv").string(), frame.frame));
    }
    frame.grey = std::move(*image);
  }
  return frames;
}

}  // namespace fusebench::run_files
