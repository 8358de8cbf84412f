// The update of the filter by a relocalised pose (keyframes.hpp).
#pragma once

#include "core/estimator/filter/filter_state.hpp"

namespace fusebench::relocalisation {

/// A relocalised pose of the IMU and the pose of the matched keyframe.
struct RelocalisedPose {
  SE3 T_world_imu;
  SE3 T_world_imu_reference;               ///< of the keyframe, the new reference frame of the patches
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_world_imu relative to the keyframe, in its tangent
  Matrix6d reference_covariance =
      Matrix6d::Zero();  ///< of the keyframe relative to the model, in its own tangent
};

/// The normalised innovation squared of a relocalised pose against the prediction, divided by its mean (six
/// degrees of freedom): about 1 if both are consistent.
[[nodiscard]] double normalised_innovation(const filter::GaussianState& prediction,
                                           const RelocalisedPose& place);

/// Covariance of (pose of a place - predicted pose): the sum of those of the prediction, of the pose relative
/// to the keyframe, and of the keyframe.
[[nodiscard]] Matrix6d innovation_covariance(const filter::GaussianState& prediction,
                                             const RelocalisedPose& place);

/// Prior of velocities if the earlier motion gives no information: zero, with these standard deviations.
struct UnknownMotion {
  double velocity_sigma_mps = 1;
  double angular_velocity_sigma_radps = 0;  ///< 0: keeps the rate measured by a gyroscope
};

/// The state after the relocalisation update: a Kalman update by the pose, with the keyframe as the new
/// reference pose (stochastic cloning). Velocity, gravity and biases are corrected through their
/// correlations. A lost filter is usually overconfident, so the covariance of pose, velocities and gravity is
/// first inflated by the normalised innovation. If that exceeds kInconsistentInnovation, the motion model was
/// wrong, and the velocities are reset to the prior of UnknownMotion.
[[nodiscard]] filter::GaussianState relocalisation_update(const filter::GaussianState& prediction,
                                                          const RelocalisedPose& place,
                                                          const UnknownMotion& unknown);

/// Larger values are inconsistent: their probability is one in two thousand (chi-square with six degrees of
/// freedom).
inline constexpr double kInconsistentInnovation = 4;

}  // namespace fusebench::relocalisation
