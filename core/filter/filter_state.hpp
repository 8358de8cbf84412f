// The state of the filter and its 33-dimensional error state.
//
// x (+) d: rotation and gravity move on their manifolds (R Exp(d), S2), everything else adds. The order of
// the error state is the order of StateOffset. World is the first camera frame, so gravity's direction is a
// state. Image measurements are relative to the frame that the patches were cut from, and to the model; the
// errors of these two are part of the state (stochastic cloning, Roumeliotis & Burdick 2002), see
// pose_clones.hpp.
#pragma once

#include "core/base/geometry.hpp"

namespace fusebench::filter {

/// Where each part of the error state begins.
enum StateOffset : int {
  kRotation = 0,            ///< rad, right perturbation of R_world_imu (IMU frame)
  kPosition = 3,            ///< m, world
  kVelocity = 6,            ///< m/s, world
  kGyroscopeBias = 9,       ///< rad/s, IMU
  kAccelerometerBias = 12,  ///< m/s^2, IMU
  kGravity = 15,            ///< rad, tangent of S2 at the gravity direction
  kAngularVelocity = 17,    ///< rad/s, IMU
  kImuTimeOffset = 20,      ///< s
  kReferencePose = 21,      ///< rad and m as the pose: error of the pose that the patches were cut at
  kModelPose = 27,          ///< the same: error of the model's pose in the world, at that pose
  kStateSize = 33,
};
inline constexpr int kPoseSize = 6;  ///< rotation and position lead the error state

using StateVector = Eigen::Matrix<double, kStateSize, 1>;
using StateMatrix = Eigen::Matrix<double, kStateSize, kStateSize>;

struct FilterState {
  SE3 T_world_imu;
  Vector3d velocity_world_mps = Vector3d::Zero();
  Vector3d gyroscope_bias_radps = Vector3d::Zero();
  Vector3d accelerometer_bias_mps2 = Vector3d::Zero();
  Vector3d gravity_direction_world = Vector3d::UnitY();  ///< unit, downwards
  /// Body rate. With an IMU it follows the gyroscope; without one it is what constant velocity extrapolates.
  Vector3d angular_velocity_imu_radps = Vector3d::Zero();
  /// IMU clock minus camera clock: a frame stamped t shows the pose at t + offset of the IMU's clock.
  double imu_time_offset_s = 0;
  SE3 T_world_imu_reference;                     ///< where the patches were cut; no error of its own
  Vector6d reference_offset = Vector6d::Zero();  ///< correction of that pose since, in its tangent
  Vector6d model_offset = Vector6d::Zero();  ///< pose offset of the model in the world, in the same tangent
};

/// Mean and covariance (in the tangent space at the mean).
struct GaussianState {
  FilterState mean;
  StateMatrix covariance = StateMatrix::Zero();
};

/// x (+) d.
[[nodiscard]] FilterState plus(const FilterState& state, const StateVector& delta);

/// The d for which from (+) d = to.
[[nodiscard]] StateVector minus(const FilterState& to, const FilterState& from);

/// Derivative of ((x (+) (d + e)) (-) (x (+) d)) by e at e = 0: carries a covariance from the chart at x to
/// the tangent space at x (+) d.
[[nodiscard]] StateMatrix chart_transport(const FilterState& state, const StateVector& delta);

/// Makes a covariance exactly symmetric again after a product.
[[nodiscard]] inline StateMatrix symmetrised(const StateMatrix& covariance) {
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace fusebench::filter
