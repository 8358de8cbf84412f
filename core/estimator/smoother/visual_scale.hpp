// Divisors of the information of images, see batch_estimate.hpp.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/estimator/smoother/batch_problem.hpp"

namespace fusebench::smoother {

/// The two divisors of the information of images.
struct VisualScale {
  double variance = 1;
  double correlation = 1;
  [[nodiscard]] double product() const { return variance * correlation; }
  /// The threshold applies to uncorrelated residuals.
  [[nodiscard]] Weighting weighting(double outlier_sigmas) const {
    return {product(), outlier_sigmas / std::sqrt(correlation)};
  }
};

/// 1 + 2 * sum of the autocorrelations of the residuals over frames, up to the first lag below 0.05 (initial
/// positive sequence, Geyer 1992).
[[nodiscard]] double correlation_factor(const std::vector<std::optional<Vector6d>>& residual_of_frame);

}  // namespace fusebench::smoother
