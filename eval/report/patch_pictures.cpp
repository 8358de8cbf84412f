#include "eval/report/patch_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

namespace fusebench::report {

namespace {

constexpr std::size_t kPatches = 4;
constexpr std::size_t kFewPatches = 10;
constexpr int kTile_px = 120;
constexpr int kGap_px = 8;
constexpr double kBrightestDifference_grey = 64;

using Pixels = std::vector<run_files::PatchTablePixel>;

/// A patch's key: its upper left pixel in the frame before, by which runs agree.
using Corner = std::pair<int, int>;

std::map<Corner, Pixels> patches_of(const run_files::PatchTableFrame& frame) {
  std::map<std::uint32_t, Pixels> by_number;
  for (const run_files::PatchTablePixel& pixel : frame.pixels) by_number[pixel.patch].push_back(pixel);
  std::map<Corner, Pixels> patches;
  for (auto& [number, pixels] : by_number) {
    Corner corner = {pixels.front().reference_px.x(), pixels.front().reference_px.y()};
    for (const run_files::PatchTablePixel& p : pixels)
      corner = {std::min(corner.first, p.reference_px.x()), std::min(corner.second, p.reference_px.y())};
    patches.emplace(corner, std::move(pixels));
  }
  return patches;
}

double mean_difference(const Pixels& pixels) {
  double sum = 0;
  for (const run_files::PatchTablePixel& p : pixels) sum += std::abs(p.reference_grey - p.observed_grey);
  return sum / static_cast<double>(pixels.size());
}

/// A square region of an image.
struct Window {
  int left = 0;
  int top = 0;
  int side = 0;
};

Eigen::Vector2f before_px(const run_files::PatchTablePixel& pixel) {
  return pixel.reference_px.cast<float>();
}
Eigen::Vector2f here_px(const run_files::PatchTablePixel& pixel) { return pixel.warped_px; }
using Place = Eigen::Vector2f (*)(const run_files::PatchTablePixel&);

Eigen::AlignedBox2f box_of(const Pixels& pixels, Place place) {
  Eigen::AlignedBox2f box;
  for (const run_files::PatchTablePixel& p : pixels) box.extend(Eigen::Vector2f(place(p)));
  return box;
}

/// Of a window that holds the patch in either frame: all tiles have one scale, so that a patch that shrinks
/// is smaller in the picture as well.
int side_of(const Pixels& pixels) {
  constexpr int kMargin_px = 3;
  const float largest =
      std::max(box_of(pixels, before_px).sizes().maxCoeff(), box_of(pixels, here_px).sizes().maxCoeff());
  return static_cast<int>(std::ceil(largest)) + 1 + 2 * kMargin_px;
}

Window window_of(const Pixels& pixels, Place place, int side) {
  const Eigen::Vector2f center = box_of(pixels, place).center();
  return {static_cast<int>(std::lround(center.x())) - side / 2,
          static_cast<int>(std::lround(center.y())) - side / 2, side};
}

/// Where there is nothing: no grey.
const cv::Vec3b kNothing = {196, 217, 240};  // red, green, blue

cv::Vec3b grey(double value) { return cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(value)); }

/// Grey levels at their nearest pixels.
template <class Value>
cv::Mat splatted(const Pixels& pixels, const Window& window, Place place, const Value& value) {
  cv::Mat tile(window.side, window.side, CV_8UC3, cv::Scalar(kNothing));
  for (const run_files::PatchTablePixel& p : pixels) {
    const Eigen::Vector2f at = place(p);
    const int x = static_cast<int>(std::lround(at.x())) - window.left;
    const int y = static_cast<int>(std::lround(at.y())) - window.top;
    if (x < 0 || y < 0 || x >= window.side || y >= window.side) continue;
    tile.at<cv::Vec3b>(y, x) = grey(value(p));
  }
  return tile;
}

cv::Mat cut(const GreyImage& image, const Window& window) {
  cv::Mat tile(window.side, window.side, CV_8UC3, cv::Scalar(kNothing));
  for (int y = 0; y < window.side; ++y) {
    for (int x = 0; x < window.side; ++x) {
      if (image.contains(window.left + x, window.top + y))
        tile.at<cv::Vec3b>(y, x) = grey(image(window.left + x, window.top + y));
    }
  }
  return tile;
}

ColorImage picture(const Pixels& pixels, const GreyImage& image, int side) {
  const Window there = window_of(pixels, before_px, side);
  const Window window = window_of(pixels, here_px, side);
  const auto reference = [](const run_files::PatchTablePixel& p) { return p.reference_grey; };
  const std::vector<cv::Mat> tiles = {
      splatted(pixels, there, before_px, reference), splatted(pixels, window, here_px, reference),
      cut(image, window), splatted(pixels, window, here_px, [](const run_files::PatchTablePixel& p) {
        return 255 * std::abs(p.reference_grey - p.observed_grey) / kBrightestDifference_grey;
      })};
  const int columns = static_cast<int>(tiles.size());
  ColorImage strip(columns * kTile_px + (columns - 1) * kGap_px, kTile_px, Rgb{255, 255, 255});
  cv::Mat view(strip.height, strip.width, CV_8UC3, strip.data.data());
  for (int i = 0; i < columns; ++i) {
    cv::resize(tiles[static_cast<std::size_t>(i)],
               view(cv::Rect(i * (kTile_px + kGap_px), 0, kTile_px, kTile_px)), {kTile_px, kTile_px}, 0, 0,
               cv::INTER_NEAREST);
  }
  return strip;
}

/// The number of a frame that all runs kept, the one with the most motion in the first run.
std::optional<std::size_t> common_frame(std::span<const LabelledPatches> runs) {
  std::optional<std::size_t> best;
  double most_px = -1;
  for (const run_files::PatchTableFrame& candidate : runs.front().frames) {
    const bool everywhere = std::ranges::all_of(runs, [&](const LabelledPatches& run) {
      return std::ranges::find(run.frames, candidate.frame, &run_files::PatchTableFrame::frame) !=
             run.frames.end();
    });
    if (!everywhere || candidate.motion_px <= most_px) continue;
    best = candidate.frame;
    most_px = candidate.motion_px;
  }
  return best;
}

}  // namespace

std::string PatchPicture::caption() const {
  return fmt::format("{}: patch at ({}, {}) px, mean difference {:.1f} grey levels{}", run, corner_px.x(),
                     corner_px.y(), difference_grey, accepted ? "" : " (rejected by the gate)");
}

PatchPictures patch_pictures(std::span<const LabelledPatches> runs) {
  PatchPictures result;
  if (runs.empty()) return result;
  const auto number = common_frame(runs);
  if (!number) return result;
  std::vector<const run_files::PatchTableFrame*> frames;
  std::vector<std::map<Corner, Pixels>> patches;
  for (const LabelledPatches& run : runs) {
    frames.push_back(&*std::ranges::find(run.frames, *number, &run_files::PatchTableFrame::frame));
    patches.push_back(patches_of(*frames.back()));
  }
  std::vector<Corner> common;
  for (const auto& [corner, pixels] : patches.front()) {
    if (std::ranges::all_of(patches, [&](const auto& other) { return other.contains(corner); }))
      common.push_back(corner);
  }
  if (common.empty()) return result;
  result.timestamp_ns = frames.front()->timestamp_ns;
  result.text = fmt::format(
      "Frame {}, the one of those kept whose patches moved most ({:.1f} px, median). Mean difference over "
      "the "
      "{} patches that all of these runs track{}:",
      *number, frames.front()->motion_px, common.size(),
      common.size() < kFewPatches ? " (few: no more than an example)" : "");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    double sum = 0;
    for (const Corner& corner : common) sum += mean_difference(patches[i].at(corner));
    result.text += fmt::format("{} {} {:.2f}", i > 0 ? "," : "", runs[i].label,
                               sum / static_cast<double>(common.size()));
  }
  result.text += fmt::format(
      " grey levels. From left to right, all at one scale: the patch in the frame before; its grey levels "
      "where they are expected in this frame; what the image has there; the absolute difference (black 0, "
      "white {:.0f} grey levels and more). Light blue: no pixel (next to a patch, where it is stretched or "
      "hidden, and outside of the image). The patches shown are evenly spaced in the list of "
      "those, from left to right in the image.",
      kBrightestDifference_grey);
  for (std::size_t k = 0; k < std::min(kPatches, common.size()); ++k) {
    const Corner& corner = common[(2 * k + 1) * common.size() / (2 * std::min(kPatches, common.size()))];
    int side = 0;
    for (const auto& of_run : patches) side = std::max(side, side_of(of_run.at(corner)));
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const Pixels& pixels = patches[i].at(corner);
      result.pictures.push_back({runs[i].label, Eigen::Vector2i(corner.first, corner.second),
                                 mean_difference(pixels), pixels.front().accepted,
                                 picture(pixels, frames[i]->grey, side)});
    }
  }
  return result;
}

}  // namespace fusebench::report
