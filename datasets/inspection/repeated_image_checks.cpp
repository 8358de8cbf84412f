// Images that are the one before again: a driver that stalled, or a list with doubled rows.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "core/io/input_file.hpp"
#include "datasets/inspection/checks.hpp"

namespace fusebench::inspection {

namespace {

// A camera that moves by less between two frames may see the same image twice.
constexpr double kVisibleMotion_px = 0.3;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream = io::input_file(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// By the size first: compressed images of one size are rare.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (a == b) return true;
  std::error_code failed_a, failed_b;
  const auto size_a = std::filesystem::file_size(a, failed_a),
             size_b = std::filesystem::file_size(b, failed_b);
  if (failed_a || failed_b || size_a != size_b) return false;
  return bytes_of(a) == bytes_of(b);
}

/// Of recordings without files: equal to the last digit in all that was measured.
bool same_color(const FrameStatistics& a, const FrameStatistics& b) {
  return a.mean_grey == b.mean_grey && a.sharpness == b.sharpness && a.dark_share == b.dark_share;
}
bool same_depth(const FrameStatistics& a, const FrameStatistics& b) {
  return a.depth_coverage > 0 && a.depth_coverage == b.depth_coverage &&
         a.depth_median_m == b.depth_median_m && a.depth_p05_m == b.depth_p05_m &&
         a.depth_p95_m == b.depth_p95_m && a.depth_max_m == b.depth_max_m;
}

/// Whether the camera moved visibly since the frame before, by truth or gyroscope.
std::vector<bool> visible_motion(const recording::Recording& recording, const Inspection& inspection) {
  std::vector<bool> moves(recording.frames.size(), true);
  for (const SpeedSample& speed : inspection.motion.speeds) {
    moves[speed.frame] =
        speed.blur_px / kBlurExposure_s * inspection.color_stamps.median_interval_s > kVisibleMotion_px;
  }
  return moves;
}

struct Repeats {
  std::vector<std::size_t> color;
  std::vector<std::size_t> depth;
};

Repeats find_repeats(const recording::Recording& recording, const Inspection& inspection) {
  std::map<std::size_t, const FrameStatistics*> sampled;
  for (const FrameStatistics& frame : inspection.images) sampled[frame.frame] = &frame;
  const std::vector<bool> moves = visible_motion(recording, inspection);
  Repeats repeats;
  for (std::size_t k = 1; k < recording.frames.size(); ++k) {
    if (!moves[k]) continue;
    const recording::FrameEntry& now = recording.frames[k];
    const recording::FrameEntry& before = recording.frames[k - 1];
    const bool files = !now.color_file.empty() && !before.color_file.empty();
    const bool both = sampled.contains(k) && sampled.contains(k - 1);
    if (files ? same_file(before.color_file, now.color_file)
              : both && same_color(*sampled[k - 1], *sampled[k]))
      repeats.color.push_back(k);
    if (files ? same_file(before.depth_file, now.depth_file)
              : both && same_depth(*sampled[k - 1], *sampled[k]))
      repeats.depth.push_back(k);
  }
  return repeats;
}

}  // namespace

void check_repeated_images(const recording::Recording& recording, Inspection& out) {
  const Repeats repeats = find_repeats(recording, out);
  out.association.repeats = repeats.color.size();
  out.association.frozen = repeats.depth.size();
  if (!repeats.color.empty()) {
    out.add("frames-duplicate-image", Severity::warning,
            fmt::format("{} colour images are the one before again; the first is that of frame {}",
                        repeats.color.size(), repeats.color.front()),
            "remove these frames from the list: the camera moved and the image did not");
  }
  if (!repeats.depth.empty() && out.association.reused == 0) {
    out.add("depth-frozen", Severity::warning,
            fmt::format("{} depth images are the one before again; the first is that of frame {}",
                        repeats.depth.size(), repeats.depth.front()),
            "remove these frames from the list: the camera moved and the depth did not");
  }
}

}  // namespace fusebench::inspection
