// Initial state: world = first camera frame, gravity from the accelerometer, zero velocity with a covariance
// that covers a start in motion.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/filter_state.hpp"

namespace fusebench::prediction {

/// Initial state from the inertial samples within `window_s` before and after the first frame. The samples
/// are rotated into the IMU frame at the first frame by the gyroscope and averaged; the mean specific force
/// is opposite to gravity. At rest the mean rate is the gyroscope bias, with a small covariance. In motion
/// the mean contains acceleration, so velocity and gravity have large covariances that the first frames
/// reduce. Error data_corrupt if the window is empty.
[[nodiscard]] Result<filter::GaussianState> initialise_with_imu(std::span<const ImuSample> samples,
                                                                std::int64_t first_frame_ns,
                                                                const SensorRig& rig,
                                                                const config::InitialisationConfig& config);

/// Initial state without an IMU: at rest with large velocity covariances. The IMU frame is the camera frame.
[[nodiscard]] filter::GaussianState initialise_without_imu(const config::InitialisationConfig& config);

/// Sets the priors of rotation and scale of the IMU.
void set_imu_priors(filter::GaussianState& state, const config::SelfCalibrationConfig& config);

/// Initial state for the configured prior, with the priors of the sensor constants. `motion`, if given,
/// provides the mean velocities. Its covariance is not used, since the frames of that estimate are processed
/// again.
[[nodiscard]] Result<filter::GaussianState> initial_state(
    std::span<const ImuSample> samples, std::int64_t first_frame_ns, const SensorRig& rig,
    const config::TermsConfig& terms, const config::InitialisationConfig& initialisation,
    const config::SelfCalibrationConfig& self_calibration, const std::optional<filter::FilterState>& motion);

/// Initial state of a separate model that begins at a dead-reckoned state: the pose is exact by definition,
/// and velocity and gravity take over its rotation error.
[[nodiscard]] filter::GaussianState begun_again(const filter::GaussianState& reckoned);

}  // namespace fusebench::prediction
