// The photometric residual of eight pixels, shared by the sums and the costs of a patch.
#pragma once

#include "core/base/simd/lanes.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/residuals_config.hpp"

namespace fusebench::measurement {

/// Residual against the patch's grey level at the given brightness, with its whitening factor.
struct GreyResidual {
  GreyResidual(const Vector2d& gain_and_offset, double noise_grey)
      : gain(static_cast<float>(gain_and_offset.x())),
        offset(static_cast<float>(gain_and_offset.y())),
        per_noise(static_cast<float>(1.0 / noise_grey)) {}

  [[nodiscard]] simd::Float8 operator()(simd::Float8 observed, simd::Float8 reference) const {
    return observed - (gain * reference + offset);
  }

  float gain;
  float offset;
  float per_noise;
};

/// Coordinate for sampling. At whole pixels, cubic interpolation returns the pixel itself, and its slope is
/// the central difference.
inline simd::Float8 sampled_at(simd::Float8 coordinate, config::Sampling sampling) {
  if (sampling == config::Sampling::bicubic) return coordinate;
  return simd::to_float(simd::to_int(coordinate + 0.5F));
}

}  // namespace fusebench::measurement
