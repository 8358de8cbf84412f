#include "datasets/inspection/frame_statistics.hpp"

#include <algorithm>

#include "datasets/inspection/measures/order_statistics.hpp"

namespace fusebench::inspection {

namespace {

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

}  // namespace

MeasuredFrame measure_frame(const RgbdFrame& frame) {
  MeasuredFrame result;
  measure_brightness(frame.grey, result.statistics);
  result.statistics.sharpness = laplacian_variance(frame.grey);
  measure_depth(frame.depth_m, result);
  return result;
}

}  // namespace fusebench::inspection
