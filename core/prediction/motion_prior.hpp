// Prediction between frames (Eqs. 8-10 and 14 of the paper): by the IMU, or by constant velocity.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"
#include "core/prediction/imu_preintegration.hpp"

namespace fusebench::prediction {

/// A prediction with the Jacobian that carried the covariance (for tests and smoothers).
struct Prediction {
  filter::GaussianState state;
  filter::StateMatrix transition =
      filter::StateMatrix::Identity();  ///< F, tangent at the old mean to tangent at the new one
};

/// What the state says of the IMU.
[[nodiscard]] InertialErrors inertial_errors(const filter::FilterState& state);

/// Propagates by pre-integrated samples. The velocity term and gravity, which Eq. 13 leaves out or misplaces,
/// are in. The increments must have been integrated with the errors of the state.
[[nodiscard]] Prediction predict_by_imu(const filter::GaussianState& state, const PreintegratedImu& imu,
                                        const ImuNoise& noise, const config::MotionConfig& config);

/// Propagates with constant linear velocity (world) and angular velocity (body) over duration_s, driven by
/// white accelerations. Biases and gravity stay as they are.
[[nodiscard]] Prediction predict_by_constant_velocity(const filter::GaussianState& state, double duration_s,
                                                      const config::MotionConfig& config);

/// Capture instants of the last frame and the one that is predicted.
struct FrameInterval {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
};

/// Sec. 2.2.1: predicts by the prior of the configuration. The samples are of the whole recording, sorted;
/// error data_corrupt if they do not cover the interval.
[[nodiscard]] Result<filter::GaussianState> predict_state(
    const filter::GaussianState& state, const FrameInterval& interval, std::span<const ImuSample> samples,
    const SensorRig& rig, const config::TermsConfig& terms, const config::MotionConfig& motion,
    const config::InitialisationConfig& initialisation,
    const config::SelfCalibrationConfig& self_calibration);

}  // namespace fusebench::prediction
