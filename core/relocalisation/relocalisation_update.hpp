// The update of the filter by a relocalised pose (keyframes.hpp).
#pragma once

#include "core/filter/filter_state.hpp"

namespace fusebench::relocalisation {

/// A relocalised pose of the IMU, and that of the keyframe which it was found by.
struct RelocalisedPose {
  SE3 T_world_imu;
  SE3 T_world_imu_reference;               ///< of the keyframe, which the patches are cut from now
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_world_imu against the keyframe, in its tangent
  Matrix6d reference_covariance =
      Matrix6d::Zero();  ///< of the keyframe against the model, in its own tangent
};

/// The normalised innovation squared of a relocalised pose against the prediction, divided by its mean (six
/// degrees of freedom): about 1 if both are consistent.
[[nodiscard]] double normalised_innovation(const filter::GaussianState& prediction,
                                           const RelocalisedPose& place);

/// The covariance of the pose of a place minus the predicted one: that of the prediction, of the pose against
/// the keyframe, and of the keyframe.
[[nodiscard]] Matrix6d innovation_covariance(const filter::GaussianState& prediction,
                                             const RelocalisedPose& place);

/// The prior of velocities where the motion so far says nothing: zero, with these standard deviations.
struct UnknownMotion {
  double velocity_sigma_mps = 1;
  double angular_velocity_sigma_radps = 0;  ///< 0: keep it, a gyroscope measures it
};

/// The state after the relocalisation update: a Kalman update by the pose, with the keyframe as the new
/// reference pose of the state (stochastic cloning). Velocity, gravity and biases are corrected by their
/// correlations with the pose. A filter that is lost is usually overconfident: the covariance of pose,
/// velocities and gravity is inflated first by the normalised innovation. If that is inconsistent
/// (kInconsistentInnovation), the motion model was wrong, and the velocities are reset to an unknown motion.
[[nodiscard]] filter::GaussianState relocalisation_update(const filter::GaussianState& prediction,
                                                          const RelocalisedPose& place,
                                                          const UnknownMotion& unknown);

/// A normalised innovation beyond this is inconsistent: it happens by chance once in two thousand (chi-square
/// of six degrees of freedom).
inline constexpr double kInconsistentInnovation = 4;

}  // namespace fusebench::relocalisation
