#include "eval/metrics/intensity_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fusebench::metrics {

namespace {

/// The reading of a number: bit by bit, the norm last.
IntensityReading reading_of(std::size_t number) {
  const auto bit = [&](unsigned at) { return ((number >> at) & 1U) != 0; };
  return {bit(4), bit(3), bit(2), bit(1), bit(0)};
}

/// Mean absolute and mean squared difference over the pixels of a frame by one reading.
struct FrameError {
  double absolute = 0;
  double squared = 0;
  bool any = false;
};

struct Sums {
  void add(double difference) {
    absolute += difference;
    squared += difference * difference;
    ++count;
  }
  double absolute = 0;
  double squared = 0;
  std::size_t count = 0;
};

FrameError mean_over_pixels(std::span<const Sums> patches) {
  Sums all;
  for (const Sums& patch : patches) {
    all.absolute += patch.absolute;
    all.squared += patch.squared;
    all.count += patch.count;
  }
  if (all.count == 0) return {};
  const auto count = static_cast<double>(all.count);
  return {all.absolute / count, all.squared / count, true};
}

FrameError mean_over_patches(std::span<const Sums> patches) {
  FrameError mean;
  double count = 0;
  for (const Sums& patch : patches) {
    if (patch.count == 0) continue;
    mean.absolute += patch.absolute / static_cast<double>(patch.count);
    mean.squared += patch.squared / static_cast<double>(patch.count);
    ++count;
  }
  if (count == 0) return {};
  return {mean.absolute / count, mean.squared / count, true};
}

/// Sums of each patch over the pixels that a reading counts.
std::vector<Sums> sums_by_patch(std::span<const SquarePixel> pixels, const IntensityReading& reading) {
  std::vector<Sums> patches;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const SquarePixel& pixel = pixels[i];
    if (i == 0 || pixel.patch != pixels[i - 1].patch) patches.emplace_back();
    if (!reading.whole_squares && !pixel.visible) continue;
    if (reading.accepted_patches && !pixel.accepted) continue;
    patches.back().add(
        static_cast<double>(reading.whole_pixels ? pixel.whole_pixel_grey : pixel.difference_grey));
  }
  return patches;
}

}  // namespace

std::array<IntensityReading, kIntensityReadings> all_intensity_readings() {
  std::array<IntensityReading, kIntensityReadings> readings;
  for (std::size_t i = 0; i < readings.size(); ++i) readings[i] = reading_of(i);
  return readings;
}

std::string to_string(const IntensityReading& reading) {
  return fmt::format("{} {} {} {} {}", reading.whole_squares ? "whole-squares" : "visible",
                     reading.whole_pixels ? "whole-pixels" : "interpolated",
                     reading.accepted_patches ? "accepted" : "tracked",
                     reading.mean_over_patches ? "over-patches" : "over-pixels",
                     reading.root_mean_square ? "root-mean-square" : "absolute");
}

double IntensityReadings::of(const IntensityReading& reading) const {
  const auto readings = all_intensity_readings();
  const auto found = std::ranges::find(readings, reading);
  return grey[static_cast<std::size_t>(found - readings.begin())];
}

void IntensityReadingsAccumulator::add_frame(std::span<const SquarePixel> pixels) {
  for (std::size_t i = 0; i < means_.size(); ++i) {
    const IntensityReading reading = reading_of(2 * i);
    const std::vector<Sums> patches = sums_by_patch(pixels, reading);
    const FrameError error =
        reading.mean_over_patches ? mean_over_patches(patches) : mean_over_pixels(patches);
    if (!error.any) continue;
    means_[i].absolute += error.absolute;
    means_[i].squared += error.squared;
    ++means_[i].frames;
  }
}

bool IntensityReadingsAccumulator::empty() const {
  return std::ranges::all_of(means_, [](const FrameMeans& means) { return means.frames == 0; });
}

IntensityReadings IntensityReadingsAccumulator::result() const {
  IntensityReadings result;
  result.grey.fill(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < means_.size(); ++i) {
    if (means_[i].frames == 0) continue;
    const auto frames = static_cast<double>(means_[i].frames);
    result.grey[2 * i] = means_[i].absolute / frames;
    result.grey[2 * i + 1] = std::sqrt(means_[i].squared / frames);
  }
  return result;
}

}  // namespace fusebench::metrics
