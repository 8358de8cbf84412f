// Motions of hand-held bodies, and what an estimator on another clock makes of them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/trajectory/trajectory.hpp"
#include "core/base/types.hpp"

namespace fusebench::testing {

using Motion = std::function<SE3(double time_s)>;

/// Sums of six sines of 0.1 to 1 Hz in each axis, by the seed.
inline Motion random_motion(unsigned seed, double rotation_rad, double translation_m) {
  struct Wave {
    double frequency_radps;
    double phase_rad;
    double amplitude;
  };
  constexpr int kWaves = 6;
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::array<std::array<Wave, kWaves>, 6> axes;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    for (Wave& wave : axes[axis]) {
      const double frequency_hz = 0.1 + 0.9 * uniform(generator);
      const double phase_rad = 2 * std::numbers::pi * uniform(generator);
      const double size = (axis < 3 ? rotation_rad : translation_m) * (2 * uniform(generator) - 1);
      wave = {2 * std::numbers::pi * frequency_hz, phase_rad, 0.3 * size / frequency_hz};
    }
  }
  return [axes](double time_s) {
    Vector6d sums = Vector6d::Zero();
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      for (const Wave& wave : axes[axis])
        sums[static_cast<int>(axis)] +=
            wave.amplitude * std::sin(wave.frequency_radps * time_s + wave.phase_rad);
    }
    return SE3{so3_exp(sums.head<3>()), sums.tail<3>()};
  };
}

inline Trajectory sampled(const Motion& motion, double begin_s, double end_s, double rate_hz) {
  Trajectory trajectory;
  for (int i = 0; begin_s + i / rate_hz < end_s; ++i) {
    const double time_s = begin_s + i / rate_hz;
    trajectory.push_back({std::llround(1e9 * time_s), motion(time_s)});
  }
  return trajectory;
}

/// Standard deviations of an estimator's errors: of each pose alone, of what is alike for correlation_s, and
/// of a random walk over a second; rotations in rad, translations in m.
struct PoseErrors {
  double white = 0;
  double correlated = 0;
  double correlation_s = 0.3;
  double walk = 0;
};

inline Trajectory with_errors(Trajectory trajectory, const PoseErrors& errors, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto random = [&] {
    Vector6d values;
    for (int axis = 0; axis < 6; ++axis) values[axis] = normal(generator);
    return values;
  };
  SE3 drift;
  Vector6d slow = errors.correlated * random();
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const double step_s =
        i == 0 ? 0 : seconds_between(trajectory[i - 1].timestamp_ns, trajectory[i].timestamp_ns);
    const double kept = std::exp(-step_s / errors.correlation_s);
    slow = kept * slow + std::sqrt(1 - kept * kept) * errors.correlated * random();
    drift = pose_plus(drift, errors.walk * std::sqrt(step_s) * random());
    const Vector6d error = errors.white * random() + slow;
    trajectory[i].T_world_camera = pose_plus(drift * trajectory[i].T_world_camera, error);
  }
  return trajectory;
}

/// The poses of another body in another frame: T_frame_world T_world_body T_body_other, lengths times
/// `scale`.
inline Trajectory seen_by(Trajectory trajectory, const SE3& T_body_other, double scale = 1) {
  const SE3 T_frame_world(so3_exp({0.3, -0.2, 1.0}), {3, -1, 2});
  for (StampedPose& pose : trajectory) {
    pose.T_world_camera = T_frame_world * pose.T_world_camera * T_body_other;
    pose.T_world_camera.translation *= scale;
  }
  return trajectory;
}

/// On a clock for which t_reference = t_estimate + offset_s.
inline Trajectory on_clock(Trajectory trajectory, double offset_s) {
  return trajectory::with_clock_offset(std::move(trajectory), -std::llround(1e9 * offset_s));
}

}  // namespace fusebench::testing
