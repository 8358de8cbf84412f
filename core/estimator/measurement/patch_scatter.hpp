// Variance factor of an estimate from patches, computed from the scatter between patches.
//
// The pixels of a patch share errors (blur, calibration, interpolation, errors of the model). Treating them
// as independent overestimates the information, by a factor that depends on sensor, scene and speed. Errors
// of different patches are nearly independent, so the scatter of their gradients around the common optimum
// gives the true variance (cluster-robust or sandwich estimate of Liang & Zeger 1986, reduced to one number).
// Errors that all patches share are not visible in the scatter; the configuration gives them.
#pragma once

#include <span>

#include "core/estimator/filter/iekf.hpp"

namespace fusebench::measurement {

/// factor: variance of the cluster gradients divided by the variance that their information matrix predicts
/// (1 for a correct noise model). freedom: degrees of freedom of this estimate (0: no clusters).
struct Scatter {
  double factor = 1;
  double freedom = 0;
};

/// Ignores clusters without information and directions of the pose without information.
[[nodiscard]] Scatter patch_scatter(std::span<const filter::PoseQuadratic> clusters);

/// Lower bound of the factor, since identical images have zero scatter.
inline constexpr double kMinVarianceFactor = 1e-3;

/// Weighted mean of the prior factor 1 (weight prior_freedom) and the measured factor (weight
/// scatter.freedom).
[[nodiscard]] double variance_factor(const Scatter& scatter, double prior_freedom);

/// Addition to the variance factor by an error common to all n measurements, of `share` standard deviations
/// of the noise of one: the variance of the mean is (1 + n share^2) / n.
[[nodiscard]] constexpr double common_error_factor(double measurements, double share) {
  return measurements * share * share;
}

}  // namespace fusebench::measurement
