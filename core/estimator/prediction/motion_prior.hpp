// Prediction between frames (Eqs. 8-10 and 14 of the paper) by the IMU or by constant velocity, and dead
// reckoning without an IMU by a motion model of hand-held cameras.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/filter_state.hpp"
#include "core/estimator/prediction/imu_preintegration.hpp"

namespace fusebench::prediction {

/// A prediction with its Jacobian (for tests and smoothers).
struct Prediction {
  filter::GaussianState state;
  filter::StateMatrix transition =
      filter::StateMatrix::Identity();  ///< F, from the tangent at the old mean to that at the new mean
};

/// The IMU errors of a state.
[[nodiscard]] InertialErrors inertial_errors(const filter::FilterState& state);

/// Propagates by pre-integrated samples, including the velocity term and gravity, which Eq. 13 omits or
/// misplaces. The increments must be integrated with the IMU errors of the state.
[[nodiscard]] Prediction predict_by_imu(const filter::GaussianState& state, const PreintegratedImu& imu,
                                        const ImuNoise& noise, const config::MotionConfig& config);

/// Propagates with constant linear (world) and angular velocity (body) over duration_s, driven by white
/// acceleration. Biases and gravity are constant. It is the prior of an update without an IMU, wide enough
/// for motions much quicker than before. Over many frames without an update its covariance is far too large;
/// use predict_by_motion_model().
[[nodiscard]] Prediction predict_by_constant_velocity(const filter::GaussianState& state, double duration_s,
                                                      const config::MotionConfig& config);

/// Stationary variances of the velocities of a recording, per axis.
struct MotionScale {
  double speed_m2ps2 = 0;   ///< of the linear velocity (world)
  double rate_rad2ps2 = 0;  ///< of the angular velocity (body)
};
/// Initial scale: motion.speed_mps and motion.rate_radps.
[[nodiscard]] MotionScale initial_motion_scale(const config::MotionConfig& config);
/// Exponential mean of the squared velocities over MotionConfig::scale_time_s, after a frame with that state
/// and duration_s since the previous frame.
[[nodiscard]] MotionScale followed_scale(const MotionScale& scale, const filter::FilterState& state,
                                         double duration_s, const config::MotionConfig& config);

/// Dead reckoning without an IMU. Propagates linear velocity (world) v and angular velocity (body) as
/// Ornstein-Uhlenbeck processes with time constants MotionConfig::speed_time_s and rate_time_s and the
/// stationary variances of `scale`: with a = exp(-dt / tau), v' = a v + n, var(n) = (1 - a^2) var(v), and the
/// pose moves by tau (1 - a) v + m, var(m) = tau^2 (2 dt / tau - 3 + 4 a - a^2) var(v), cov(m, n) = tau (1 -
/// a)^2 var(v). Exact for any division of dt. Biases and gravity do not change.
[[nodiscard]] Prediction predict_by_motion_model(const filter::GaussianState& state, double duration_s,
                                                 const MotionScale& scale,
                                                 const config::MotionConfig& config);

/// Capture instants of the last frame and of the predicted one.
struct FrameInterval {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
};

/// Sec. 2.2.1: predicts by the IMU of a recording. `samples`: of the whole recording, sorted; error
/// data_corrupt if they do not cover the interval.
[[nodiscard]] Result<filter::GaussianState> predict_by_samples(
    const filter::GaussianState& state, const FrameInterval& interval, std::span<const ImuSample> samples,
    const SensorRig& rig, const config::TermsConfig& terms, const config::MotionConfig& motion,
    const config::InitialisationConfig& initialisation,
    const config::SelfCalibrationConfig& self_calibration);

}  // namespace fusebench::prediction
