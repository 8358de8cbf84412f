#include "eval/metrics/intensity_metrics.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"

namespace fusebench::metrics {

namespace {

/// Sorted by key, the first occurrence of each.
std::vector<IntensityResidual> unique_pixels(const std::vector<IntensityResidual>& pixels) {
  std::vector<IntensityResidual> result = pixels;
  std::stable_sort(result.begin(), result.end(),
                   [](const IntensityResidual& a, const IntensityResidual& b) { return a.pixel < b.pixel; });
  const auto same = [](const IntensityResidual& a, const IntensityResidual& b) { return a.pixel == b.pixel; };
  result.erase(std::unique(result.begin(), result.end(), same), result.end());
  return result;
}

}  // namespace

void IntensityAccumulator::add(Sums& sums, double sum, double squares, std::size_t count) {
  if (count == 0) {
    ++sums.frames_excluded;
    return;
  }
  sums.frame_mean.push_back(sum / static_cast<double>(count));
  sums.frame_mean_square.push_back(squares / static_cast<double>(count));
  sums.pixels += count;
}

void IntensityAccumulator::add_frame(std::span<const IntensityResidual> pixels) {
  double sum = 0, squares = 0, accepted_sum = 0, accepted_squares = 0;
  std::size_t accepted_count = 0;
  for (const IntensityResidual& pixel : pixels) {
    const double difference = static_cast<double>(pixel.difference_grey);
    sum += difference;
    squares += difference * difference;
    if (!pixel.accepted) continue;
    accepted_sum += difference;
    accepted_squares += difference * difference;
    ++accepted_count;
  }
  add(all_, sum, squares, pixels.size());
  add(accepted_, accepted_sum, accepted_squares, accepted_count);
}

IntensitySummary IntensityAccumulator::summary(const Sums& sums) {
  IntensitySummary result;
  result.stats = statistics(sums.frame_mean);
  result.aie_grey = result.stats.mean;
  result.rms_grey = std::sqrt(statistics(sums.frame_mean_square).mean);
  result.pixels = sums.pixels;
  result.frames = sums.frame_mean.size();
  result.frames_excluded = sums.frames_excluded;
  return result;
}

IntensityResult IntensityAccumulator::result() const { return {summary(all_), summary(accepted_)}; }

double frame_intensity_error(std::span<const IntensityResidual> pixels) {
  double sum = 0;
  for (const IntensityResidual& pixel : pixels) sum += static_cast<double>(pixel.difference_grey);
  return pixels.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(pixels.size());
}

void CommonIntensityAccumulator::add_frame(std::span<const std::vector<IntensityResidual>> runs) {
  check(runs.size() == sums_.size(), "one list of pixels per run");
  std::vector<std::vector<IntensityResidual>> pixels;
  for (const auto& run : runs) pixels.push_back(unique_pixels(run));

  std::vector<std::uint32_t> common;
  for (std::size_t run = 0; run < pixels.size(); ++run) {
    std::vector<std::uint32_t> keys;
    for (const IntensityResidual& pixel : pixels[run]) {
      if (run == 0 || std::binary_search(common.begin(), common.end(), pixel.pixel)) {
        keys.push_back(pixel.pixel);
      }
    }
    common = std::move(keys);
  }
  for (std::size_t run = 0; run < pixels.size(); ++run) {
    std::erase_if(pixels[run], [&](const IntensityResidual& pixel) {
      return !std::binary_search(common.begin(), common.end(), pixel.pixel);
    });
    sums_[run].add_frame(pixels[run]);
  }
}

std::vector<IntensitySummary> CommonIntensityAccumulator::result() const {
  std::vector<IntensitySummary> result;
  for (const IntensityAccumulator& run : sums_) result.push_back(run.result().all);
  return result;
}

}  // namespace fusebench::metrics
