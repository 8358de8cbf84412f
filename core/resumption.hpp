// How the filter goes on from a place that was found again (keyframes.hpp).
#pragma once

#include "core/filter_state.hpp"

namespace fusebench {

/// Where the IMU was found, and where it was when the frame was taken that told it.
struct RecognisedPlace {
  SE3 T_world_imu;
  SE3 T_world_imu_reference;                         ///< the frame that the patches are cut from now
  Matrix6d covariance = Matrix6d::Zero();            ///< of T_world_imu against that frame, in its tangent
  Matrix6d reference_covariance = Matrix6d::Zero();  ///< of that frame against the model, in its own tangent
};

/// How much a place contradicts the prediction: the normalised innovation squared over its mean; 1 if both
/// are right.
[[nodiscard]] double contradiction(const GaussianState& prediction, const RecognisedPlace& place);

/// Velocities where the motion before is of no use: zero, with these standard deviations.
struct UnknownMotion {
  double velocity_sigma_mps = 1;
  double angular_velocity_sigma_radps = 0;  ///< 0: a gyroscope knows it all the same
};

/// The state after the place has been heard: a Kalman update by the match, with the error of the frame that
/// told it as the reference pose of the state. Velocity, gravity and biases learn what their correlations
/// with the pose let them. A filter that lost its way was usually too sure of itself: the variance of pose,
/// velocities and gravity grows first by as much as the place contradicts it. If it contradicts it clearly
/// (kSurprise), the camera has not moved as the filter thinks, and its velocities are unknown.
[[nodiscard]] GaussianState resumed(const GaussianState& prediction, const RecognisedPlace& place,
                                    const UnknownMotion& unknown);

/// A contradiction of this much happens by chance once in two thousand (chi-square of six degrees of
/// freedom).
inline constexpr double kSurprise = 4;

}  // namespace fusebench
