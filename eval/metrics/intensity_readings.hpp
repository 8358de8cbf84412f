// The intensity error by other definitions than that of AIE (intensity_metrics.hpp): the paper does not
// define its own, and each definition gives another number.
//
// A reading chooses five things: over which pixels of a tracked patch (the visible ones, or the whole square,
// in which a pixel without a surface moves as the visible ones of its patch do in the mean), how the image is
// read where a pixel lands (interpolated, or at the nearest whole pixel), over which patches (all tracked
// ones, or those that passed the chi-square gate), how the mean is taken in a frame (over all pixels, or over
// each patch and then over the patches), and the norm (mean of absolute differences, or root of the mean of
// squares). Each is then a mean over frames. AIE is visible, interpolated, tracked, over pixels, absolute.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/intensity_residual.hpp"

namespace fusebench::metrics {

/// One definition. A default one is that of AIE.
struct IntensityReading {
  bool whole_squares = false;
  bool whole_pixels = false;
  bool accepted_patches = false;
  bool mean_over_patches = false;
  bool root_mean_square = false;

  [[nodiscard]] bool operator==(const IntensityReading&) const = default;
};

inline constexpr std::size_t kIntensityReadings = 32;
/// All of them, in a fixed order; the first is AIE.
[[nodiscard]] std::array<IntensityReading, kIntensityReadings> all_intensity_readings();
/// "visible interpolated tracked over-pixels absolute".
[[nodiscard]] std::string to_string(const IntensityReading& reading);

/// Values in the order of all_intensity_readings(), grey levels; NaN where no frame has such pixels.
struct IntensityReadings {
  std::array<double, kIntensityReadings> grey{};

  [[nodiscard]] double of(const IntensityReading& reading) const;
};

/// Adds up frames one at a time.
class IntensityReadingsAccumulator {
 public:
  /// Pixels of a patch are in a row. A frame without pixels counts for nothing.
  void add_frame(std::span<const SquarePixel> pixels);
  [[nodiscard]] bool empty() const;
  [[nodiscard]] IntensityReadings result() const;

 private:
  struct FrameMeans {
    double absolute = 0;  ///< sums over frames of the frame's mean
    double squared = 0;
    std::size_t frames = 0;
  };
  std::array<FrameMeans, kIntensityReadings / 2> means_;  ///< by everything but the norm
};

}  // namespace fusebench::metrics
