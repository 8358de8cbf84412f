// A motion that swings about and along all axes, with its inertial measurements: every part of a calibration
// of camera and IMU shows in it.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/types.hpp"

namespace fusebench::testing {

struct SwingingMotion {
  double swing_rad = 0.5;  ///< amplitude of the angles
  double sway_m = 0.15;    ///< amplitude of the position
  Vector3d axes{1, 1, 1};  ///< share of the swing about x, y and z
  Vector3d gravity_world_mps2{0, kGravity_mps2, 0};

  [[nodiscard]] Quaterniond R_world_imu(double t) const {
    return so3_exp({0, swing_rad * axes.y() * std::sin(3.1 * t + 0.4), 0}) *
           so3_exp({swing_rad * axes.x() * std::sin(4.3 * t + 1.1), 0, 0}) *
           so3_exp({0, 0, swing_rad * axes.z() * std::sin(3.7 * t + 2.0)});
  }
  [[nodiscard]] SE3 T_world_imu(double t) const {
    return {R_world_imu(t),
            sway_m * Vector3d(std::sin(2.3 * t), std::sin(2.9 * t + 0.7), std::sin(1.9 * t + 1.5))};
  }
  [[nodiscard]] Vector3d velocity_world_mps(double t) const {
    return sway_m *
           Vector3d(2.3 * std::cos(2.3 * t), 2.9 * std::cos(2.9 * t + 0.7), 1.9 * std::cos(1.9 * t + 1.5));
  }
  [[nodiscard]] Vector3d angular_velocity_radps(double t) const {
    constexpr double kStep = 1e-4;  // the error is of second order: 1e-8
    return so3_log(R_world_imu(t - kStep).conjugate() * R_world_imu(t + kStep)) / (2 * kStep);
  }
  [[nodiscard]] Vector3d specific_force_mps2(double t) const {
    const Vector3d acceleration =
        -sway_m * Vector3d(2.3 * 2.3 * std::sin(2.3 * t), 2.9 * 2.9 * std::sin(2.9 * t + 0.7),
                           1.9 * 1.9 * std::sin(1.9 * t + 1.5));
    return R_world_imu(t).conjugate() * (acceleration - gravity_world_mps2);
  }

  /// Samples at a rate. Their stamps are later by offset_s than the instants; white noise of the densities.
  [[nodiscard]] std::vector<ImuSample> samples(double begin_s, double end_s, double rate_hz, double offset_s,
                                               const Vector3d& gyroscope_bias,
                                               const Vector3d& accelerometer_bias, const ImuNoise& noise,
                                               std::mt19937& random) const {
    std::normal_distribution<double> normal;
    const auto white = [&](double density) -> Vector3d {
      const double sigma = density * std::sqrt(rate_hz);
      return {sigma * normal(random), sigma * normal(random), sigma * normal(random)};
    };
    std::vector<ImuSample> result;
    const auto count = static_cast<int>(std::lround((end_s - begin_s) * rate_hz));
    for (int i = 0; i <= count; ++i) {
      const double t = begin_s + i / rate_hz;
      result.push_back(
          {static_cast<std::int64_t>(std::llround(1e9 * (t + offset_s))),
           angular_velocity_radps(t) + gyroscope_bias + white(noise.gyroscope_radps_sqrthz),
           specific_force_mps2(t) + accelerometer_bias + white(noise.accelerometer_mps2_sqrthz)});
    }
    return result;
  }
};

}  // namespace fusebench::testing
