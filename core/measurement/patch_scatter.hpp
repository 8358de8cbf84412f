// Variance factor of an estimate from patches, from the scatter between patches.
//
// The pixels of a patch share their errors (blur, calibration, interpolation, a bump of the model), so the
// information of all pixels as if they were independent is too optimistic, by a factor that differs between
// sensors, scenes and speeds. Patches err nearly independently of each other, so the scatter of their
// gradients around the common optimum shows the true variance (the cluster-robust, or sandwich, estimate of
// Liang & Zeger 1986, reduced to one number). What all patches have in common does not show in it, and is
// told by the configuration.
#pragma once

#include <span>

#include "core/filter/iekf.hpp"

namespace fusebench::measurement {

/// `factor` is the variance of the gradients of clusters over the one that their information matrix predicts
/// (1 if the noise model is right); `freedom` the degrees of freedom of this estimate (0: no clusters).
struct Scatter {
  double factor = 1;
  double freedom = 0;
};

/// Clusters without information are left out; so are directions of the pose in which there is none.
[[nodiscard]] Scatter patch_scatter(std::span<const filter::PoseQuadratic> clusters);

/// Lower bound of the factor: identical images have no scatter at all.
inline constexpr double kMinVarianceFactor = 1e-3;

/// The mean of a prior factor of 1, which weighs `prior_freedom`, and the measured one.
[[nodiscard]] double variance_factor(const Scatter& scatter, double prior_freedom);

/// What an error that all measurements of a frame have in common, of `share` standard deviations of the noise
/// of one, adds to the variance factor of the estimate from all of them: the variance of the mean of n such
/// measurements is (1 + n share^2) / n.
[[nodiscard]] constexpr double common_error_factor(double measurements, double share) {
  return measurements * share * share;
}

}  // namespace fusebench::measurement
