// The noise of a depth measurement.
#pragma once

#include "core/base/simd/lanes.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::preprocessing {

/// Standard deviation of depth for eight measurements.
class DepthSigma {
 public:
  explicit DepthSigma(const config::DepthConfig& config);  ///< inline in depth_gates.hpp

  [[nodiscard]] simd::Float8 at_m(simd::Float8 depth_m) const {
    const simd::Float8 z = depth_m - offset_m_;
    return simd::multiply_add(quadratic_per_m_ * z, z, simd::all_lanes(floor_m_));
  }

 private:
  float floor_m_, quadratic_per_m_, offset_m_;
};

}  // namespace fusebench::preprocessing
