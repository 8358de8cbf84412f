// Selection of depth measurements, and their noise.
#pragma once

#include "core/base/simd/lanes.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/estimator/preprocessing/depth_sigma.hpp"

namespace fusebench::preprocessing {

/// Standard deviation of a depth measurement: a + b (z - c)^2 (metres; Nguyen et al. 2012).
[[nodiscard]] inline double depth_sigma_m(double depth_m, const config::DepthConfig& config) {
  const double z = depth_m - config.noise_offset_m;
  return config.noise_floor_m + config.noise_quadratic_per_m * z * z;
}

inline DepthSigma::DepthSigma(const config::DepthConfig& config)
    : floor_m_(static_cast<float>(config.noise_floor_m)),
      quadratic_per_m_(static_cast<float>(config.noise_quadratic_per_m)),
      offset_m_(static_cast<float>(config.noise_offset_m)) {}

/// depth_sigma_m() of eight measurements.
[[nodiscard]] inline simd::Float8 depth_sigma_m(simd::Float8 depth_m, const config::DepthConfig& config) {
  return DepthSigma(config).at_m(depth_m);
}

/// Copies depth without unreliable measurements: values outside [min, max] and pixels at a depth edge become
/// 0. Reuses the memory of the result.
void gate_depth(const DepthImage& depth_m, const config::DepthConfig& config, DepthImage& gated_m);

/// True if the pixel and its eight neighbours at distance reach_px (those inside the image) have depth and
/// differ by at most `edge_jump` of the depth at the pixel. With reach 0, tests the pixel alone.
[[nodiscard]] bool is_one_surface(const DepthImage& depth_m, int x, int y, int reach_px, double edge_jump);

}  // namespace fusebench::preprocessing
