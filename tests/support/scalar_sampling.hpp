// Grey levels between pixels for one place in double precision: what samples at eight places at a time
// (core/base/simd/image_lanes.hpp) are held against.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/base/image.hpp"

namespace fusebench::testing {

/// Weights of the four pixels around a place between the second and the third, and their derivatives.
struct CubicWeights {
  explicit CubicWeights(double t)
      : value{t * (-0.5 + t * (1.0 - 0.5 * t)), 1.0 + t * t * (-2.5 + 1.5 * t),
              t * (0.5 + t * (2.0 - 1.5 * t)), t * t * (-0.5 + 0.5 * t)},
        slope{-0.5 + t * (2.0 - 1.5 * t), t * (-5.0 + 4.5 * t), 0.5 + t * (4.0 - 4.5 * t),
              t * (-1.0 + 1.5 * t)} {}
  std::array<double, 4> value;
  std::array<double, 4> slope;
};

/// Cubic convolution (Keys 1981, a = -1/2) with the exact derivative of the interpolant. Needs
/// 1 <= x <= width - 2 (same for y); the caller checks.
inline IntensitySample sample_bicubic(const GreyImage& image, double x, double y) {
  const int x0 = std::clamp(static_cast<int>(x), 1, image.width - 3);
  const int y0 = std::clamp(static_cast<int>(y), 1, image.height - 3);
  const CubicWeights across(x - x0);
  const CubicWeights down(y - y0);
  IntensitySample sample;
  const std::uint8_t* row = &image.data[image.index(x0 - 1, y0 - 1)];
  for (std::size_t j = 0; j < 4; ++j, row += image.width) {
    double value = 0;
    double slope = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      value += across.value[i] * row[i];
      slope += across.slope[i] * row[i];
    }
    sample.value += down.value[j] * value;
    sample.dx += down.value[j] * slope;
    sample.dy += down.slope[j] * value;
  }
  return sample;
}

}  // namespace fusebench::testing
