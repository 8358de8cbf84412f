// A short recording in the textured room with exact truth and an exact IMU.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/replay.hpp"
#include "tests/support/analytic_motion.hpp"
#include "tests/support/rolling_shutter.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench::testing {

struct SimulatedRun {
  SensorRig rig;
  std::vector<RgbdFrame> frames;
  std::vector<SE3> T_first_camera;  ///< truth in the estimator's world
  std::vector<ImuSample> imu;
};

/// `count` frames at 30 Hz of a hand-held-like motion (0.3 m/s; the default rate is 1 rad/s), IMU at 200 Hz,
/// 9 cm from the camera. Each row is rendered at the time that `timing` gives it.
inline SimulatedRun simulate(int count, const SensorTiming& timing = {},
                             const Vector3d& body_rate_radps = {0.3, 0.9, -0.4}) {
  SimulatedRun run;
  run.rig.timing = timing;
  run.rig.camera = small_camera();
  run.rig.T_imu_camera = {so3_exp({0.01, -0.02, 0.015}), {0.09, 0.003, 0.002}};
  run.rig.imu_noise = {1e-3, 2e-2, 5e-5, 6e-4};
  HelixMotion motion;
  motion.radius_m = 0.12;
  motion.turn_radps = 2.5;
  motion.climb_mps = 0.1;
  motion.body_rate_radps = body_rate_radps;
  const double begin_s = 1.0;  // not at the identity, and in motion
  const TexturedRoom room;
  const auto T_room_camera = [&](double t) {
    // Turn back by the rotation at the beginning, so that the camera looks along the room.
    const SE3 begin = motion.T_world_imu(begin_s);
    return SE3{Quaterniond::Identity(), begin.translation} *
           SE3{begin.rotation, begin.translation}.inverse() * motion.T_world_imu(t) * run.rig.T_imu_camera;
  };
  for (int k = 0; k < count; ++k) {
    const double t = begin_s + k / 30.0;
    run.frames.push_back(render_rolling(room, run.rig.camera, timing,
                                        [&](double after_s) { return T_room_camera(t + after_s); }));
    run.frames.back().timestamp_ns = static_cast<std::int64_t>(std::llround(1e9 * t));
    run.T_first_camera.push_back(T_room_camera(begin_s).inverse() * T_room_camera(t));
  }
  run.imu = motion.samples(begin_s - 0.5, begin_s + count / 30.0 + 0.5, 200);
  return run;
}

/// Of all these frames, which must outlive it.
inline Replay replay_of(const std::vector<RgbdFrame>& frames) {
  return [&frames](const FrameVisitor& visit) -> Result<void> {
    for (const RgbdFrame& frame : frames) {
      if (auto visited = visit(frame); !visited) return visited;
    }
    return {};
  };
}

}  // namespace fusebench::testing
