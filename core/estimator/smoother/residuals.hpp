// Residuals of the batch estimator, for Ceres' automatic derivatives.
// Parameter blocks: rotations as quaternions x, y, z, w; positions and velocities (world); biases (gyroscope,
// accelerometer); gravity direction; camera extrinsic; IMU clock offset; scale errors of gyroscope and
// accelerometer; timing errors of the image sensors, one block each.
#pragma once

#include <ceres/rotation.h>

#include "core/base/geometry.hpp"
#include "core/base/types.hpp"
#include "core/estimator/prediction/imu_preintegration.hpp"
#include "core/estimator/smoother/relative_motion.hpp"

namespace fusebench::smoother {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

template <class T>
Vector3<T> rotation_vector(const Eigen::Quaternion<T>& q) {
  const T ordered[4] = {q.w(), q.x(), q.y(), q.z()};
  Vector3<T> vector;
  ceres::QuaternionToAngleAxis(ordered, vector.data());
  return vector;
}

template <class T>
Eigen::Quaternion<T> rotation_by(const Vector3<T>& vector) {
  T q[4];
  ceres::AngleAxisToQuaternion(vector.data(), q);
  return {q[0], q[1], q[2], q[3]};
}

template <class T>
Eigen::Map<const Eigen::Quaternion<T>> as_rotation(const T* x) {
  return Eigen::Map<const Eigen::Quaternion<T>>(x);
}
template <class T>
Eigen::Map<const Vector3<T>> as_vector(const T* x) {
  return Eigen::Map<const Vector3<T>>(x);
}

/// Residual of pre-integrated increments, linearised in biases, scales and clock offset at their values of
/// the integration.
struct InertialResidual {
  prediction::PreintegratedImu imu;
  prediction::InertialErrors errors;  ///< used in the integration
  double time_offset_s;               ///< used in the integration
  prediction::Matrix9d whitening;     ///< of (rotation, velocity, position)

  template <class T>
  bool operator()(const T* rotation_i, const T* position_i, const T* velocity_i, const T* bias_i,
                  const T* rotation_j, const T* position_j, const T* velocity_j, const T* gravity_direction,
                  const T* time_offset, const T* gyroscope_scale, const T* accelerometer_scale,
                  T* residual) const {
    const T shift = time_offset[0] - time_offset_s;
    Eigen::Matrix<T, 12, 1> change;
    change << as_vector(bias_i) - errors.gyroscope_bias_radps,
        as_vector(bias_i + 3) - errors.accelerometer_bias_mps2,
        as_vector(gyroscope_scale) - errors.gyroscope_scale,
        as_vector(accelerometer_scale) - errors.accelerometer_scale;
    const auto by_change = [&](const prediction::ByInertialErrors& by_errors) -> Vector3<T> {
      return by_errors.leftCols<6>() * change.template head<6>() +
             by_errors.rightCols<6>() * change.template tail<6>();
    };
    const Vector3<T> turn = by_change(imu.rotation_by_errors) + imu.rotation_by_time_offset * shift;
    const Eigen::Quaternion<T> R_measured = imu.delta_rotation.cast<T>() * rotation_by<T>(turn);
    const Vector3<T> velocity_change =
        imu.delta_velocity_mps + by_change(imu.velocity_by_errors) + imu.velocity_by_time_offset * shift;
    const Vector3<T> position_change =
        imu.delta_position_m + by_change(imu.position_by_errors) + imu.position_by_time_offset * shift;

    const double dt = imu.duration_s;
    const Eigen::Quaternion<T> R_imu_world = as_rotation(rotation_i).conjugate();
    const Vector3<T> fall = as_vector(gravity_direction) * T(kGravity_mps2);
    const Vector3<T> velocity = as_vector(velocity_i);
    Eigen::Matrix<T, 9, 1> error;
    error.template head<3>() =
        rotation_vector<T>(R_measured.conjugate() * (R_imu_world * as_rotation(rotation_j)));
    error.template segment<3>(3) =
        R_imu_world * Vector3<T>(as_vector(velocity_j) - velocity - fall * T(dt)) - velocity_change;
    error.template tail<3>() = R_imu_world * Vector3<T>(as_vector(position_j) - as_vector(position_i) -
                                                        velocity * T(dt) - fall * T(0.5 * dt * dt)) -
                               position_change;
    Eigen::Map<Eigen::Matrix<T, 9, 1>> result(residual);
    result = whitening * error;
    return true;
  }
};

/// Random walk of the biases.
struct BiasWalkResidual {
  double gyroscope_sigma;      ///< of one step
  double accelerometer_sigma;  ///< of one step

  template <class T>
  bool operator()(const T* bias_i, const T* bias_j, T* residual) const {
    for (int k = 0; k < 3; ++k) {
      residual[k] = (bias_j[k] - bias_i[k]) / gyroscope_sigma;
      residual[k + 3] = (bias_j[k + 3] - bias_i[k + 3]) / accelerometer_sigma;
    }
    return true;
  }
};

/// Relative camera motion measured by the images, and its dependence on their timing.
struct VisualResidual {
  RelativeCameraMotion motion;
  Matrix6d whitening;

  template <class T>
  bool operator()(const T* rotation_reference, const T* position_reference, const T* rotation,
                  const T* position, const T* rotation_imu_camera, const T* position_imu_camera,
                  const T* color_readout, const T* depth_readout, const T* depth_delay, T* residual) const {
    const Eigen::Quaternion<T> R_imu_camera = as_rotation(rotation_imu_camera);
    const Eigen::Quaternion<T> R_world_reference = as_rotation(rotation_reference) * R_imu_camera;
    const Vector3<T> lever = as_vector(position_imu_camera);
    const Vector3<T> camera = as_rotation(rotation) * lever + as_vector(position);
    const Vector3<T> reference = as_rotation(rotation_reference) * lever + as_vector(position_reference);
    const SE3& measured = motion.T_reference_camera;
    Eigen::Matrix<T, 6, 1> error;
    error.template head<3>() =
        rotation_vector<T>(measured.rotation.conjugate().cast<T>() *
                           (R_world_reference.conjugate() * (as_rotation(rotation) * R_imu_camera)));
    error.template tail<3>() =
        R_world_reference.conjugate() * Vector3<T>(camera - reference) - measured.translation;
    const Vector3<T> timing(color_readout[0], depth_readout[0], depth_delay[0]);
    error -= motion.by_timing * Vector3<T>(timing - motion.timing_s);
    Eigen::Map<Eigen::Matrix<T, 6, 1>> result(residual);
    result = whitening * error;
    return true;
  }
};

/// Information of the images of a frame on the timing.
struct TimingResidual {
  VisualTiming measured;
  double per_sigma;  ///< factor on the residual

  template <class T>
  bool operator()(const T* color_readout, const T* depth_readout, const T* depth_delay, T* residual) const {
    const Vector3<T> timing(color_readout[0], depth_readout[0], depth_delay[0]);
    Eigen::Map<Vector3<T>> result(residual);
    result = (measured.root * Vector3<T>(timing - measured.timing_s) + measured.residual) * T(per_sigma);
    return true;
  }
};

/// Gaussian prior on a rotation.
struct RotationPrior {
  Quaterniond expected;
  double sigma_rad;

  template <class T>
  bool operator()(const T* rotation, T* residual) const {
    Eigen::Map<Vector3<T>> result(residual);
    result = rotation_vector<T>(expected.conjugate().cast<T>() * as_rotation(rotation)) / T(sigma_rad);
    return true;
  }
};

/// Gaussian prior on a vector, with independent components.
template <int Size>
struct VectorPrior {
  Eigen::Matrix<double, Size, 1> expected;
  Eigen::Matrix<double, Size, 1> sigma;

  template <class T>
  bool operator()(const T* value, T* residual) const {
    for (int k = 0; k < Size; ++k) residual[k] = (value[k] - expected[k]) / sigma[k];
    return true;
  }
};

}  // namespace fusebench::smoother
