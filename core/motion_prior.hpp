// Prediction between frames (Eqs. 8-10 and 14 of the paper): by the IMU, or by constant velocity.
#pragma once

#include "core/config.hpp"
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

}  // namespace fusebench
