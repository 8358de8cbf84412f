// Prediction between frames (Eqs. 8-10 and 14 of the paper): by the IMU, or by constant velocity.
#pragma once

#include <cstdint>
#include <span>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/filter_state.hpp"
#include "core/imu_preintegration.hpp"

namespace fusebench {

/// A prediction with the Jacobian that carried the covariance (for tests and smoothers).
struct Prediction {
  GaussianState state;
  StateMatrix transition = StateMatrix::Identity();  ///< F, tangent at the old mean to tangent at the new one
};

/// Propagates by pre-integrated samples. The velocity term and gravity, which Eq. 13 leaves out or misplaces,
/// are in. The increments must have been integrated with the biases of the state.
[[nodiscard]] Prediction predict_by_imu(const GaussianState& state, const PreintegratedImu& imu,
                                        const ImuNoise& noise, const MotionConfig& config);

/// Propagates with constant linear velocity (world) and angular velocity (body) over duration_s, driven by
/// white accelerations. Biases and gravity stay as they are.
[[nodiscard]] Prediction predict_by_constant_velocity(const GaussianState& state, double duration_s,
                                                      const MotionConfig& config);

/// Capture instants of the last frame and the one that is predicted.
struct FrameInterval {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
};

/// Sec. 2.2.1: predicts by the prior of the configuration. The samples are of the whole recording, sorted;
/// error data_corrupt if they do not cover the interval.
[[nodiscard]] Result<GaussianState> predict_state(const GaussianState& state, const FrameInterval& interval,
                                                  std::span<const ImuSample> samples, const ImuNoise& noise,
                                                  const Config& config);

}  // namespace fusebench
