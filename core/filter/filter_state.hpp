// The state of the filter and its 57-dimensional error state.
//
// x (+) d: rotation and gravity move on their manifolds (R Exp(d), S2), everything else adds. The order of
// the error state is the order of StateOffset. World is the first camera frame, so gravity's direction is a
// state. Image measurements are relative to the frame that the patches were cut from, and to the model; the
// errors of these two, of pose and of motion during their read-out, are part of the state (stochastic
// cloning, Roumeliotis & Burdick 2002), see pose_clones.hpp.
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
  kImuRotation = 21,        ///< rad: this and what follows are those of SensorErrors
  kGyroscopeScale = 24,
  kAccelerometerScale = 27,
  kColorReadout = 30,   ///< s
  kDepthReadout = 31,   ///< s
  kDepthDelay = 32,     ///< s
  kReferencePose = 33,  ///< rad and m as the pose: error of the pose that the patches were cut at
  kModelPose = 39,      ///< the same: error of the model's pose in the world, at that pose
  kReferenceRate = 45,  ///< rad/s and m/s as pose_rate(), at that pose: error of the motion undone there
  kModelRate = 51,      ///< the same, of what was fused into the model
  kStateSize = 57,
};
inline constexpr int kPoseSize = 6;    ///< rotation and position lead the error state
inline constexpr int kTimingSize = 3;  ///< from kColorReadout on
/// What decides where a row that was read apart from the frame's instant is seen from: the timing, one for
/// the timing that was undone in reference and model, then the rate of the pose (as pose_rate()) against that
/// of the reference, and against that of the model.
inline constexpr int kReadoutSize = kTimingSize + 1 + 2 * kPoseSize;
/// The constants of the sensors: from kImuTimeOffset on.
inline constexpr int kSensorSize = kReferencePose - kImuTimeOffset;

using StateVector = Eigen::Matrix<double, kStateSize, 1>;
using StateMatrix = Eigen::Matrix<double, kStateSize, kStateSize>;

/// What the calibration of the sensors leaves out: constants, estimated with the motion.
struct SensorErrors {
  /// Rotation vector from the axes in which the IMU measures to those of T_imu_camera.
  Vector3d imu_rotation_rad = Vector3d::Zero();
  Vector3d gyroscope_scale = Vector3d::Zero();      ///< what is measured is 1 + scale times the rate, by axis
  Vector3d accelerometer_scale = Vector3d::Zero();  ///< the same
  // Beyond what SensorRig::timing says.
  double color_readout_s = 0;
  double depth_readout_s = 0;
  double depth_delay_s = 0;

  /// These three, in the order of the error state.
  [[nodiscard]] Vector3d timing_s() const { return {color_readout_s, depth_readout_s, depth_delay_s}; }
};

/// The motion during the read-out of the frames that the model was fused from, weighted as these are in it:
/// tangents of the pose (pose_rate()) at the reference pose.
struct FusedReadout {
  Vector6d rate = Vector6d::Zero();
  // The rate, times the errors of the timing that were supposed then (SensorErrors::timing_s()).
  Vector6d by_readout = Vector6d::Zero();
  Vector6d by_delay = Vector6d::Zero();
};

struct FilterState {
  SE3 T_world_imu;
  Vector3d velocity_world_mps = Vector3d::Zero();
  Vector3d gyroscope_bias_radps = Vector3d::Zero();
  Vector3d accelerometer_bias_mps2 = Vector3d::Zero();
  Vector3d gravity_direction_world = Vector3d::UnitY();  ///< unit, downwards
  /// Body rate. With an IMU it follows the gyroscope; without one it is what constant velocity extrapolates.
  Vector3d angular_velocity_imu_radps = Vector3d::Zero();
  double angular_velocity_noise_radps = 0;  ///< of it, by axis, new in each frame, by data sheet; no state
  /// IMU clock minus camera clock: a frame stamped t shows the pose at t + offset of the IMU's clock.
  double imu_time_offset_s = 0;
  SensorErrors sensors;
  SE3 T_world_imu_reference;                     ///< where the patches were cut; no error of its own
  Vector6d reference_rate = Vector6d::Zero();    ///< motion there, see pose_rate()
  Vector6d reference_offset = Vector6d::Zero();  ///< correction of that pose since, in its tangent
  Vector6d model_offset = Vector6d::Zero();  ///< pose offset of the model in the world, in the same tangent
  Vector6d reference_rate_offset = Vector6d::Zero();  ///< correction of reference_rate since
  /// By how much the motion differs from what was undone in the frames that are in the model.
  Vector6d model_rate_offset = Vector6d::Zero();
  /// The error of the read-out of colour that was supposed there; no errors of their own, these two.
  double reference_color_readout_s = 0;
  FusedReadout model_readout;
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

/// The tangent of the pose that a second of the current motion adds: rotation (rad/s, IMU axes) and position
/// (m/s, world).
[[nodiscard]] Vector6d pose_rate(const FilterState& state);

/// Makes a covariance exactly symmetric again after a product.
[[nodiscard]] StateMatrix symmetrised(const StateMatrix& covariance);

}  // namespace fusebench::filter
