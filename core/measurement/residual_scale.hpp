// Standard deviations of residuals, estimated from earlier frames. They differ between sensors and scenes
// (noise, texture, blur), and robust weights and the chi-square gate need them.
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

/// Moves the scale towards the estimate from the accepted patches of a frame, by iekf.scale_share: the one
/// for which the mean of min(r^2, k |r|) is that of normal residuals (in the manner of Huber's Proposal 2,
/// 1964), so that outliers count little. Stays within a factor of kMaxScale of the configuration.
[[nodiscard]] ResidualScale followed_scale(const ResidualScale& scale, std::span<const PatchOutcome> outcomes,
                                           const config::IekfConfig& iekf,
                                           const config::PhotometricConfig& photometric,
                                           const config::GeometricConfig& geometric);

inline constexpr double kMaxScale = 5.0;

}  // namespace fusebench::measurement
