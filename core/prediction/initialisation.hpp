// The first state: world = first camera frame, gravity from the accelerometer, zero velocity with a
// covariance that covers a start in motion.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"

namespace fusebench::prediction {

/// Initial state from the inertial samples within `window_s` before and after the first frame. Samples of the
/// window are turned into the IMU frame at the first frame by the gyroscope and averaged: the mean specific
/// force points against gravity. At rest the gyroscope's mean is its bias and the covariances are tight; in
/// motion the mean contains acceleration, and velocity and gravity start with wide covariances which the
/// first frames then shrink. Error data_corrupt if the window is empty.
[[nodiscard]] Result<filter::GaussianState> initialise_with_imu(std::span<const ImuSample> samples,
                                                                std::int64_t first_frame_ns,
                                                                const SensorRig& rig,
                                                                const config::InitialisationConfig& config);

/// Initial state without an IMU: at rest with wide velocity covariances. The "IMU" frame is the camera's.
[[nodiscard]] filter::GaussianState initialise_without_imu(const config::InitialisationConfig& config);

/// Rotation and scale of the IMU.
void set_imu_priors(filter::GaussianState& state, const config::SelfCalibrationConfig& config);

/// Selects one of these two by the configured prior, with the priors of the sensors' constants. `motion`, if
/// known, gives the velocities; only the means, since the frames that they were estimated from are used as
/// measurements next.
[[nodiscard]] Result<filter::GaussianState> initial_state(
    std::span<const ImuSample> samples, std::int64_t first_frame_ns, const SensorRig& rig,
    const config::TermsConfig& terms, const config::InitialisationConfig& initialisation,
    const config::SelfCalibrationConfig& self_calibration, const std::optional<filter::FilterState>& motion);

/// The first state of a model of its own that begins at a dead-reckoned state: the pose is known by
/// definition, and velocity and gravity take over its error in rotation.
[[nodiscard]] filter::GaussianState begun_again(const filter::GaussianState& reckoned);

}  // namespace fusebench::prediction
