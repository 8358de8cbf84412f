// A smooth motion in closed form, with its exact inertial measurements.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/types.hpp"

namespace fusebench::testing {

/// An IMU on a helix that also turns about a tilted axis at a constant rate: pose, velocity, angular velocity
/// and specific force at any time, exactly.
struct HelixMotion {
  double radius_m = 0.4;
  double turn_radps = 2.0;  ///< along the helix
  double climb_mps = 0.15;
  Vector3d body_rate_radps{0.7, -1.1, 0.4};  ///< constant in the body frame
  Vector3d gravity_world_mps2{0, kGravity_mps2, 0};

  [[nodiscard]] SE3 T_world_imu(double t) const {
    const double a = turn_radps * t;
    return {so3_exp(body_rate_radps * t), {radius_m * std::cos(a), radius_m * std::sin(a), climb_mps * t}};
  }
  [[nodiscard]] Vector3d velocity_world_mps(double t) const {
    const double a = turn_radps * t;
    return {-radius_m * turn_radps * std::sin(a), radius_m * turn_radps * std::cos(a), climb_mps};
  }
  [[nodiscard]] Vector3d specific_force_mps2(double t) const {
    const double a = turn_radps * t;
    const double centripetal = radius_m * turn_radps * turn_radps;
    const Vector3d acceleration(-centripetal * std::cos(a), -centripetal * std::sin(a), 0);
    return T_world_imu(t).rotation.conjugate() * (acceleration - gravity_world_mps2);
  }
  /// Samples at a rate from begin_s, biases added.
  [[nodiscard]] std::vector<ImuSample> samples(double begin_s, double end_s, double rate_hz,
                                               const Vector3d& gyroscope_bias = Vector3d::Zero(),
                                               const Vector3d& accelerometer_bias = Vector3d::Zero()) const {
    std::vector<ImuSample> result;
    const auto count = static_cast<int>(std::lround((end_s - begin_s) * rate_hz));
    for (int i = 0; i <= count; ++i) {
      const double t = begin_s + i / rate_hz;
      result.push_back({static_cast<std::int64_t>(std::llround(1e9 * t)), body_rate_radps + gyroscope_bias,
                        specific_force_mps2(t) + accelerometer_bias});
    }
    return result;
  }
};

}  // namespace fusebench::testing
