// Standard deviations of residuals, estimated from earlier frames. They depend on sensor and scene (noise,
// texture, blur). Robust weights and the chi-square gate use them.
#pragma once

#include <span>

#include "core/config/groups/config_fwd.hpp"

namespace fusebench::measurement {

struct PatchOutcome;

/// Factors on the configured standard deviations.
struct ResidualScale {
  double photometric = 1;
  double geometric = 1;
};

/// Moves the scale by iekf.scale_share towards the estimate from the accepted patches of a frame. The
/// estimate equates the mean of min(r^2, k |r|) with that of normal residuals (similar to Huber's Proposal 2,
/// 1964), so outliers have little weight. Limited to a factor of kMaxScale.
[[nodiscard]] ResidualScale followed_scale(const ResidualScale& scale, std::span<const PatchOutcome> outcomes,
                                           const config::IekfConfig& iekf,
                                           const config::PhotometricConfig& photometric,
                                           const config::GeometricConfig& geometric);

inline constexpr double kMaxScale = 5.0;

}  // namespace fusebench::measurement
