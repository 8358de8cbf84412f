// Exposure, sharpness and depth of sampled frames; images that are the one before again: a driver that
// stalled, or a list with doubled rows.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "core/base/io/input_file.hpp"
#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/order_statistics.hpp"

namespace fusebench::inspection {

namespace {

struct MeasuredFrame {
  FrameStatistics statistics;  ///< frame and time_s are left to the caller
  std::array<std::uint64_t, kDepthBins> histogram{};
  std::uint64_t measured = 0;  ///< pixels with depth
  std::uint64_t beyond_10m = 0;
  std::uint64_t below_quarter_metre = 0;
  float depth_min_m = 0;  ///< of measured pixels
};

constexpr int kSaturated_grey = 250;
constexpr int kDark_grey = 5;

void measure_brightness(const GreyImage& grey, FrameStatistics& out) {
  std::uint64_t sum = 0, saturated = 0, dark = 0;
  for (const std::uint8_t level : grey.data) {
    sum += level;
    saturated += level >= kSaturated_grey ? 1 : 0;
    dark += level <= kDark_grey ? 1 : 0;
  }
  const auto pixels = static_cast<double>(std::max<std::size_t>(1, grey.data.size()));
  out.mean_grey = static_cast<double>(sum) / pixels;
  out.saturated_share = static_cast<double>(saturated) / pixels;
  out.dark_share = static_cast<double>(dark) / pixels;
}

double laplacian_variance(const GreyImage& grey) {
  std::int64_t sum = 0, squares = 0, count = 0;
  for (int y = 1; y + 1 < grey.height; ++y) {
    for (int x = 1; x + 1 < grey.width; ++x) {
      const int laplacian =
          4 * grey(x, y) - grey(x - 1, y) - grey(x + 1, y) - grey(x, y - 1) - grey(x, y + 1);
      sum += laplacian;
      squares += static_cast<std::int64_t>(laplacian) * laplacian;
      ++count;
    }
  }
  if (count == 0) return 0;
  const double mean = static_cast<double>(sum) / static_cast<double>(count);
  return static_cast<double>(squares) / static_cast<double>(count) - mean * mean;
}

void measure_depth(const DepthImage& depth_m, MeasuredFrame& out) {
  std::vector<double> sample;  // every third pixel of every third row is enough for quantiles
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      const float z_m = depth_m(x, y);
      if (z_m <= 0) continue;
      out.depth_min_m = out.measured == 0 ? z_m : std::min(out.depth_min_m, z_m);
      out.statistics.depth_max_m = std::max(out.statistics.depth_max_m, static_cast<double>(z_m));
      ++out.measured;
      out.beyond_10m += z_m > 10 ? 1 : 0;
      out.below_quarter_metre += z_m < 0.25F ? 1 : 0;
      const auto bin =
          static_cast<std::size_t>(std::min(z_m / kDepthBin_m, static_cast<double>(kDepthBins - 1)));
      ++out.histogram[bin];
      if (x % 3 == 0 && y % 3 == 0) sample.push_back(static_cast<double>(z_m));
    }
  }
  const auto pixels = static_cast<double>(std::max<std::size_t>(1, depth_m.data.size()));
  out.statistics.depth_coverage = static_cast<double>(out.measured) / pixels;
  out.statistics.depth_p05_m = measures::quantile(sample, 0.05);
  out.statistics.depth_median_m = measures::quantile(sample, 0.5);
  out.statistics.depth_p95_m = measures::quantile(std::move(sample), 0.95);
}

MeasuredFrame measure_frame(const RgbdFrame& frame) {
  MeasuredFrame result;
  measure_brightness(frame.grey, result.statistics);
  result.statistics.sharpness = laplacian_variance(frame.grey);
  measure_depth(frame.depth_m, result);
  return result;
}

struct LoadedStatistics {
  std::optional<MeasuredFrame> measured;
  std::string error;
};

std::vector<std::size_t> sampled_frames(std::size_t frames, std::size_t samples) {
  std::vector<std::size_t> result;
  const std::size_t count = std::min(frames, std::max<std::size_t>(1, samples));
  for (std::size_t i = 0; i < count; ++i) result.push_back(i * frames / count);
  return result;
}

template <class Value>
double median_of(const std::vector<FrameStatistics>& frames, Value FrameStatistics::*member) {
  std::vector<double> values;
  for (const FrameStatistics& frame : frames) values.push_back(frame.*member);
  return measures::median(std::move(values));
}

/// Range of the mean brightness after a running median over a second, which blinking lights do not move.
double brightness_drift(const std::vector<FrameStatistics>& frames) {
  double low = 255, high = 0;
  for (const FrameStatistics& centre : frames) {
    std::vector<double> around;
    for (const FrameStatistics& frame : frames) {
      if (std::abs(frame.time_s - centre.time_s) <= 0.5) around.push_back(frame.mean_grey);
    }
    const double level = measures::median(std::move(around));
    low = std::min(low, level);
    high = std::max(high, level);
  }
  return frames.empty() ? 0 : high - low;
}

void check_exposure(Inspection& out) {
  ExposureMeasurement& e = out.exposure;
  e.mean_grey = median_of(out.images, &FrameStatistics::mean_grey);
  e.saturated_share = median_of(out.images, &FrameStatistics::saturated_share);
  e.dark_share = median_of(out.images, &FrameStatistics::dark_share);
  e.drift_grey = brightness_drift(out.images);
  std::vector<double> sharpness;
  for (const FrameStatistics& frame : out.images) sharpness.push_back(frame.sharpness);
  e.sharpness_median = measures::median(sharpness);
  e.sharpness_p05 = measures::quantile(std::move(sharpness), 0.05);
  if (e.mean_grey < 30) {
    out.add("underexposed", Severity::warning,
            fmt::format("the images are dark: mean {:.0f} of 255, {:.0f} % of pixels at 5 and below",
                        e.mean_grey, 100 * e.dark_share),
            "patches need gradients above the camera's noise; expect few");
  }
  if (e.saturated_share > 0.2) {
    out.add("overexposed", Severity::warning,
            fmt::format("{:.0f} % of pixels are saturated (250 and above)", 100 * e.saturated_share),
            "saturated regions have no texture to track");
  }
  if (e.drift_grey > 40) {
    out.add("brightness-drift", Severity::note,
            fmt::format("the mean brightness moves over {:.0f} grey levels (exposure control, or the scene)",
                        e.drift_grey),
            "intensity errors contain it unless the variant estimates brightness");
  }
}

void check_depth_values(Inspection& out) {
  const DepthMeasurement& depth = out.depth;
  const auto empty = std::ranges::count_if(
      out.images, [](const FrameStatistics& frame) { return frame.depth_coverage < 0.01; });
  if (empty > 0) {
    const bool all = static_cast<std::size_t>(empty) == out.images.size();
    out.add("depth-empty", all ? Severity::error : Severity::warning,
            fmt::format("{} of {} sampled frames have depth in less than 1 % of their pixels", empty,
                        out.images.size()),
            "these frames cannot be fused");
    if (all) return;
  }
  if (depth.coverage_median < 0.4) {
    out.add("depth-holes", Severity::warning,
            fmt::format("the median frame has depth in {:.0f} % of its pixels", 100 * depth.coverage_median),
            "patches need depth: expect few where there are holes; --filtered-depth takes the depth that a "
            "recording's authors have filled");
  }
  // A room is a few metres deep, and sensors for rooms measure from about 0.3 m to 10 m.
  const bool far = depth.median_m > 4.5 || depth.beyond_10m_share > 0.05;
  const bool near = depth.median_m < 0.45 || depth.below_quarter_metre_share > 0.1;
  // A close-up is near, too: only what no sensor measures is an error without ground truth.
  const bool sure = depth.median_m > 6 || depth.beyond_10m_share > 0.2 || (near && depth.median_m < 0.1);
  if (far || near) {
    out.add(
        "depth-range", sure ? Severity::error : Severity::warning,
        fmt::format("the median depth is {:.3g} m, {:.0f} % of it beyond 10 m and {:.0f} % below 0.25 m: {} "
                    "than assumed",
                    depth.median_m, 100 * depth.beyond_10m_share, 100 * depth.below_quarter_metre_share,
                    far ? "the value of a metre is probably larger (5000 rather than 1000?)"
                        : "a close-up, or the value of a metre is smaller (1000 rather than 5000?)"),
        "set units_per_metre in [depth] of calibration.toml");
  }
}

void gather_depth(const std::vector<LoadedStatistics>& loaded, Inspection& out) {
  DepthMeasurement& depth = out.depth;
  depth.histogram.assign(kDepthBins, 0);
  std::vector<double> coverage, medians;
  std::uint64_t measured = 0, beyond = 0, below = 0;
  for (const LoadedStatistics& frame : loaded) {
    if (!frame.measured) continue;
    const MeasuredFrame& m = *frame.measured;
    coverage.push_back(m.statistics.depth_coverage);
    if (m.measured == 0) continue;
    medians.push_back(m.statistics.depth_median_m);
    depth.min_m = measured == 0 ? static_cast<double>(m.depth_min_m)
                                : std::min(depth.min_m, static_cast<double>(m.depth_min_m));
    depth.max_m = std::max(depth.max_m, m.statistics.depth_max_m);
    measured += m.measured;
    beyond += m.beyond_10m;
    below += m.below_quarter_metre;
    for (std::size_t bin = 0; bin < kDepthBins; ++bin) depth.histogram[bin] += m.histogram[bin];
  }
  if (!coverage.empty()) depth.coverage_min = *std::ranges::min_element(coverage);
  depth.coverage_median = measures::median(std::move(coverage));
  depth.median_m = measures::median(std::move(medians));
  if (measured == 0) return;
  depth.beyond_10m_share = static_cast<double>(beyond) / static_cast<double>(measured);
  depth.below_quarter_metre_share = static_cast<double>(below) / static_cast<double>(measured);
}

void report_unreadable(const std::vector<LoadedStatistics>& loaded, Inspection& out) {
  std::size_t unreadable = 0;
  const std::string* first = nullptr;
  for (const LoadedStatistics& frame : loaded) {
    if (frame.measured) continue;
    ++unreadable;
    if (first == nullptr) first = &frame.error;
  }
  if (first == nullptr) return;
  out.add("frame-unreadable", Severity::error,
          fmt::format("{} of {} sampled frames cannot be loaded; the first: {}", unreadable, loaded.size(),
                      *first),
          "copy or download these files again");
}

}  // namespace

void check_images(const recording::Recording& recording, const Workers& workers,
                  const InspectOptions& options, Inspection& out) {
  const std::vector<std::size_t> frames = sampled_frames(recording.frames.size(), options.image_samples);
  const auto loaded = workers.map_chunks<LoadedStatistics>(frames.size(), 1, [&](std::size_t i, std::size_t) {
    LoadedStatistics result;
    const auto frame = recording.load_frame(frames[i]);
    if (!frame) {
      result.error = frame.error().message;
    } else {
      result.measured = measure_frame(*frame);
    }
    return result;
  });
  report_unreadable(loaded, out);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!loaded[i].measured) continue;
    FrameStatistics statistics = loaded[i].measured->statistics;
    statistics.frame = frames[i];
    statistics.time_s =
        seconds_between(recording.frames.front().timestamp_ns, recording.frames[frames[i]].timestamp_ns);
    out.images.push_back(statistics);
  }
  if (out.images.empty()) return;
  gather_depth(loaded, out);
  check_exposure(out);
  check_depth_values(out);
}

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
