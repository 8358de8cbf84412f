// Pre-integration of inertial samples between two frames (Eqs. 11-13 of the paper, in the form of Forster et
// al., "On-Manifold Preintegration", T-RO 2017): gravity-free increments in the IMU frame at the first
// instant.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"
#include "core/base/types.hpp"

namespace fusebench::prediction {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Measurement errors of an IMU. A rate w (or specific force) in the axes of T_imu_camera is measured as (1 +
/// scale) . (Exp(-rotation) (w + bias)), by axis.
struct InertialErrors {
  Vector3d gyroscope_bias_radps = Vector3d::Zero();
  Vector3d accelerometer_bias_mps2 = Vector3d::Zero();
  Vector3d rotation_rad = Vector3d::Zero();
  Vector3d gyroscope_scale = Vector3d::Zero();
  Vector3d accelerometer_scale = Vector3d::Zero();
};
inline constexpr int kInertialErrors = 15;  ///< number of errors, in this order
using ByInertialErrors = Eigen::Matrix<double, 3, kInertialErrors>;

/// The sample corrected by these errors.
[[nodiscard]] ImuSample corrected(const ImuSample& sample, const InertialErrors& errors);

/// Motion between two instants as measured by the IMU, with first-order derivatives by its errors.
struct PreintegratedImu {
  double duration_s = 0;
  Quaterniond delta_rotation = Quaterniond::Identity();  ///< R_begin_end
  Vector3d delta_velocity_mps = Vector3d::Zero();  ///< without gravity, in the IMU frame at the beginning
  Vector3d delta_position_m = Vector3d::Zero();    ///< without gravity and initial velocity, same frame
  Matrix9d covariance = Matrix9d::Zero();          ///< of (rotation (right), velocity, position)
  ByInertialErrors rotation_by_errors = ByInertialErrors::Zero();
  ByInertialErrors velocity_by_errors = ByInertialErrors::Zero();
  ByInertialErrors position_by_errors = ByInertialErrors::Zero();
  Vector3d rotation_by_time_offset =
      Vector3d::Zero();  ///< rad/s: derivative by a common shift of both instants
  Vector3d velocity_by_time_offset = Vector3d::Zero();     ///< m/s^2
  Vector3d position_by_time_offset = Vector3d::Zero();     ///< m/s
  Vector3d angular_velocity_end_radps = Vector3d::Zero();  ///< corrected rate at the end
  ByInertialErrors angular_velocity_end_by_errors = ByInertialErrors::Zero();
  Vector3d angular_acceleration_end_radps2 = Vector3d::Zero();  ///< derivative of the rate at the end
  double last_step_s = 0;                                       ///< spacing of the samples at the end
  double rate_averaged_s = 0;  ///< averaging time with the same noise as the rate at the end
};

/// Integrates from begin to end by the mid-point rule, with samples interpolated at both instants. `samples`
/// are sorted by time. If they end up to 50 ms before either instant, the nearest one is held; beyond that,
/// error data_corrupt with the times.
[[nodiscard]] Result<PreintegratedImu> preintegrate(std::span<const ImuSample> samples, std::int64_t begin_ns,
                                                    std::int64_t end_ns, const InertialErrors& errors,
                                                    const ImuNoise& noise);

}  // namespace fusebench::prediction
