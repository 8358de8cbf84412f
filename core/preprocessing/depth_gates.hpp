// Which depth measurements are used, and how noisy they are.
#pragma once

#include "core/base/types.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/preprocessing/depth_sigma.hpp"
#include "core/simd/lanes.hpp"

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

/// Depth without unreliable measurements: values outside [min, max] and pixels at a depth edge become 0. Into
/// another image, whose memory is used again.
void gate_depth(const DepthImage& depth_m, const config::DepthConfig& config, DepthImage& gated_m);

/// True if there is depth at the pixel and at the eight around it at a distance of reach_px, as far as they
/// are in the image, without a jump of more than `edge_jump` of the middle's depth. Reach 0: the pixel alone.
[[nodiscard]] bool is_one_surface(const DepthImage& depth_m, int x, int y, int reach_px, double edge_jump);

}  // namespace fusebench::preprocessing
