#include "core/estimator/measurement/residual_scale.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/residuals_config.hpp"
#include "core/estimator/measurement/patch_measurement.hpp"

namespace fusebench::measurement {

namespace {

double followed(double scale, double robust_sum, int residuals, double huber_sigmas, double share) {
  if (residuals == 0) return scale;
  // For standard normal r, the mean of min(r^2, k |r|) is the probability of |r| < k.
  const double expected = std::erf(huber_sigmas / std::numbers::sqrt2);
  const double variance_ratio = robust_sum / residuals / expected;
  const double moved = scale * std::sqrt(1.0 + share * (variance_ratio - 1.0));
  return std::clamp(moved, 1.0 / kMaxScale, kMaxScale);
}

}  // namespace

ResidualScale followed_scale(const ResidualScale& scale, std::span<const PatchOutcome> outcomes,
                             const config::IekfConfig& iekf, const config::PhotometricConfig& photometric,
                             const config::GeometricConfig& geometric) {
  double photometric_sum = 0, geometric_sum = 0;
  int photometric_count = 0, geometric_count = 0;
  for (const PatchOutcome& outcome : outcomes) {
    if (!outcome.accepted) continue;
    photometric_sum += outcome.robust_photometric;
    geometric_sum += outcome.robust_geometric;
    photometric_count += outcome.photometric_residuals;
    geometric_count += outcome.geometric_residuals;
  }
  const double share = iekf.scale_share;
  return {followed(scale.photometric, photometric_sum, photometric_count, photometric.huber_sigmas, share),
          followed(scale.geometric, geometric_sum, geometric_count, geometric.huber_sigmas, share)};
}

}  // namespace fusebench::measurement
