// Fits time offset, rotation, scale and bias between the turns of a camera and those of a gyroscope.
#pragma once

#include <optional>

#include "datasets/inspection/measures/camera_turns.hpp"
#include "datasets/inspection/measures/gyroscope_integral.hpp"

namespace fusebench::inspection::measures {

/// turn_imu(t + offset) = rotation * turn_camera(t) + bias * duration, by robust least
/// squares: single wrong turns of either side do not decide.
struct TurnAlignment {
  std::size_t intervals = 0;
  bool offset_found = false;  ///< the optimum lies within the offsets that are searched, not at their end
  double time_offset_s = 0;
  double time_offset_sigma_s = 0;
  Matrix3d rotation_imu_camera =
      Matrix3d::Identity();       ///< orthogonal; determinant -1 if mirrored fits clearly better
  double rotation_sigma_rad = 0;  ///< standard deviation about the axis that is known worst
  double scale = 1;               ///< of the gyroscope's turns to the camera's
  Vector3d bias_radps = Vector3d::Zero();
  double residual_radps = 0;  ///< rms, all axes
  double explained = 0;       ///< share of the variance of the gyroscope's rates
  double camera_rms_radps = 0;
  // Weighted sums over the intervals at the offset found, without their parts that are proportional to the
  // duration, which the bias explains.
  Matrix3d cross_rad2 = Matrix3d::Zero();  ///< sum of turn_imu turn_camera^T
  double imu_rad2 = 0;                     ///< sum of |turn_imu|^2
  double camera_rad2 = 0;                  ///< sum of |turn_camera|^2
  double freedom = 1;                      ///< of the residuals

  /// Sum of squared residuals with another rotation, at its best scale (not below 0) and bias.
  [[nodiscard]] double cost_of(const Matrix3d& other_rotation_imu_camera) const;
};

/// Searches offsets within +-0.5 s; one within 0.01 s of an end counts as not found. Nothing if fewer than 8
/// intervals lie within the gyroscope's time, or the camera turns by less than 3 deg/s rms.
[[nodiscard]] std::optional<TurnAlignment> align_turns(const CameraTurns& turns,
                                                       const GyroscopeIntegral& gyroscope);

}  // namespace fusebench::inspection::measures
