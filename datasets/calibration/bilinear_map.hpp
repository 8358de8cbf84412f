// Resampling of colour images by a map that is known beforehand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/image.hpp"

namespace fusebench::calibration {

/// Where each pixel of an image comes from, interpolated bilinearly between pixels in fixed point (1/32
/// pixel, results rounded to nearest), so that the result is the same on every machine. Positions outside of
/// the image are moved to its border.
///
/// Neighbours mostly come from neighbours: a lens moves them by nearly the same. So a row is a few dozen runs
/// of pixels that are as far from their sources, and a run is resampled like a row, many bytes at once.
class BilinearMap {
 public:
  static constexpr int kFractions = 32;  ///< per pixel

  /// For images of this size; a map of none cannot be applied.
  BilinearMap() = default;
  BilinearMap(int width_px, int height_px);

  /// The source of the next pixel, row by row, in 1/32 pixels.
  void add(std::int32_t x, std::int32_t y);

  /// Checks that the image has the map's size, and that all its pixels have a source.
  [[nodiscard]] ColorImage apply(const ColorImage& source) const;

 private:
  /// Bytes of the image: from `target` on, as many behind `source`.
  struct Run {
    std::size_t target = 0;
    std::size_t source = 0;
    std::size_t count = 0;
  };

  int width_px_ = 0;
  int height_px_ = 0;
  std::size_t right_ = 0;  ///< bytes to the neighbour on the right, and to the one below
  std::size_t down_ = 0;
  std::vector<Run> runs_;
  std::vector<std::uint8_t> x_weight_;  ///< of the right neighbours, for each byte of the image: 0 to 32
  std::vector<std::uint8_t> y_weight_;  ///< of those below
};

}  // namespace fusebench::calibration
