// Long trajectories with a known error, for the programs that measure their evaluation.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/types.hpp"

namespace fusebench::testing {

inline constexpr std::int64_t kWanderingStep_ns = 10'000'000;

/// A wandering camera with a pose every 10 ms.
inline Trajectory wandering(std::int64_t poses) {
  Trajectory trajectory;
  trajectory.reserve(static_cast<std::size_t>(poses));
  for (std::int64_t i = 0; i < poses; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    trajectory.push_back({1'305'031'100'000'000'000 + i * kWanderingStep_ns,
                          {so3_exp(Vector3d(0.3 * std::sin(t), 0.2 * std::cos(2 * t), 0.1 * t)),
                           Vector3d(5 * std::sin(t), 3 * std::sin(1.7 * t), std::cos(2.3 * t))}});
  }
  return trajectory;
}

/// In another world and a quarter step later, with an error along y whose amplitude is error_m.
inline Trajectory seen_from_elsewhere(const Trajectory& truth, double error_m) {
  const SE3 T_other_world{so3_exp(Vector3d(0.4, -1.0, 2.0)), Vector3d(1, -2, 3)};
  Trajectory estimate = truth;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    estimate[i].timestamp_ns += kWanderingStep_ns / 4;
    SE3& pose = estimate[i].T_world_camera;
    pose.translation.y() += i % 2 == 0 ? error_m : -error_m;
    pose = T_other_world * pose;
  }
  return estimate;
}

}  // namespace fusebench::testing
