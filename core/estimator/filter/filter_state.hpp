// The state of the filter and its 57-dimensional error state.
//
// x (+) d: rotation and gravity move on their manifolds (R Exp(d), S2), everything else adds. StateOffset
// gives the order. The world frame is the first camera frame, so the direction of gravity is a state. Image
// measurements are relative to the reference frame of the patches and to the model. The errors of the pose
// and of the read-out motion of both are part of the state (stochastic cloning, Roumeliotis & Burdick 2002);
// see pose_clones.hpp.
#pragma once

#include "core/base/geometry.hpp"

namespace fusebench::filter {

/// First index of each part of the error state.
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
  kColorReadout = 30,   ///< rad; kImuRotation to kDepthDelay are the errors of SensorErrors
  kDepthReadout = 31,   ///< s
  kDepthDelay = 32,     ///< s
  kReferencePose = 33,  ///< rad and m as the pose: error of the reference pose of the patches
  kModelPose = 39,      ///< rad and m: error of the model's pose in the world, at the reference pose
  kReferenceRate = 45,  ///< rad/s and m/s as pose_rate(): error of the motion compensated in the reference
  kModelRate = 51,      ///< rad/s and m/s: error of the motion compensated in the fused frames
  kStateSize = 57,
};
inline constexpr int kPoseSize = 6;    ///< rotation and position are the first entries of the error state
inline constexpr int kTimingSize = 3;  ///< three entries from kColorReadout on
/// Size of the read-out errors: timing (3), the affine term (1), the rate of the pose against the reference
/// (6) and against the model (6). See ReadoutVector in iekf.hpp.
inline constexpr int kReadoutSize = kTimingSize + 1 + 2 * kPoseSize;
/// The constants of the sensors, from kImuTimeOffset on.
inline constexpr int kSensorSize = kReferencePose - kImuTimeOffset;

using StateVector = Eigen::Matrix<double, kStateSize, 1>;
using StateMatrix = Eigen::Matrix<double, kStateSize, kStateSize>;

/// Errors of the sensor calibration: constants that are estimated with the motion.
struct SensorErrors {
  /// Rotation vector from the measurement axes of the IMU to the axes of T_imu_camera.
  Vector3d imu_rotation_rad = Vector3d::Zero();
  Vector3d gyroscope_scale = Vector3d::Zero();  ///< measured rate = (1 + scale) * rate, by axis
  /// measured specific force = (1 + scale) * specific force, by axis
  Vector3d accelerometer_scale = Vector3d::Zero();
  // Corrections added to SensorRig::timing.
  double color_readout_s = 0;
  double depth_readout_s = 0;
  double depth_delay_s = 0;

  /// (color_readout_s, depth_readout_s, depth_delay_s), in the order of the error state.
  [[nodiscard]] Vector3d timing_s() const { return {color_readout_s, depth_readout_s, depth_delay_s}; }
};

/// Read-out motion of the frames that were fused into the model, averaged with the weights of the fusion.
/// Tangents as pose_rate(), at the reference pose.
struct FusedReadout {
  Vector6d rate = Vector6d::Zero();
  // Mean of rate * timing error that was assumed at fusion (SensorErrors::timing_s()).
  Vector6d by_readout = Vector6d::Zero();
  Vector6d by_delay = Vector6d::Zero();
};

struct FilterState {
  SE3 T_world_imu;
  Vector3d velocity_world_mps = Vector3d::Zero();
  Vector3d gyroscope_bias_radps = Vector3d::Zero();
  Vector3d accelerometer_bias_mps2 = Vector3d::Zero();
  Vector3d gravity_direction_world = Vector3d::UnitY();  ///< unit, downwards
  /// Body rate: with an IMU from the gyroscope, without one from the constant-velocity model.
  Vector3d angular_velocity_imu_radps = Vector3d::Zero();
  /// data-sheet noise by axis, independent in each frame; not a state
  double angular_velocity_noise_radps = 0;
  /// IMU clock minus camera clock: a frame with stamp t shows the pose at IMU time t + offset.
  double imu_time_offset_s = 0;
  SensorErrors sensors;
  SE3 T_world_imu_reference;  ///< reference pose of the patches; its error is reference_offset
  Vector6d reference_rate = Vector6d::Zero();  ///< pose_rate() at the reference pose
  /// correction of the reference pose since the cut, in its tangent
  Vector6d reference_offset = Vector6d::Zero();
  Vector6d model_offset = Vector6d::Zero();  ///< pose offset of the model in the world, in the same tangent
  Vector6d reference_rate_offset = Vector6d::Zero();  ///< correction of reference_rate since the cut
  /// Difference between the motion of the fused frames and the motion compensated in them.
  Vector6d model_rate_offset = Vector6d::Zero();
  /// Colour read-out error that was assumed in the reference. This value and model_readout have no error
  /// states.
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

/// The d with from (+) d = to.
[[nodiscard]] StateVector minus(const FilterState& to, const FilterState& from);

/// Derivative of (x (+) (d + e)) (-) (x (+) d) with respect to e at e = 0. Transports a covariance from the
/// chart at x to the tangent space at x (+) d.
[[nodiscard]] StateMatrix chart_transport(const FilterState& state, const StateVector& delta);

/// Rate of the pose in its tangent: angular velocity (rad/s, IMU axes) and velocity (m/s, world).
[[nodiscard]] Vector6d pose_rate(const FilterState& state);

/// (C + C^T) / 2, which restores exact symmetry after a product.
[[nodiscard]] StateMatrix symmetrised(const StateMatrix& covariance);

}  // namespace fusebench::filter
