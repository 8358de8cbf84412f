// Text tables of stamps, inertial samples and states, in the columns of EuRoC MAV (Burri et al., IJRR 2016).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/types.hpp"
#include "core/estimator/filter/stamped_state.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

/// imu0/data.csv: "timestamp [ns], angular velocity [rad/s], specific force [m/s^2]" in the IMU's axes, as
/// accelerometers read it (+9.81 upwards at rest).
[[nodiscard]] std::string imu_table(std::span<const ImuSample> samples);

/// state_groundtruth_estimate0/data.csv: "timestamp [ns], position [m], attitude (w x y z), velocity [m/s],
/// gyroscope bias [rad/s], accelerometer bias [m/s^2]": of the IMU in the ground truth's world.
[[nodiscard]] std::string state_table(std::span<const filter::StampedState> states);

/// Its first eight columns, where velocities and biases are not known: poses of the body in the ground
/// truth's world.
[[nodiscard]] std::string pose_table(std::span<const StampedPose> T_world_body);

/// "frame timestamp" by row, in seconds: for formats whose frames have numbers and no time.
[[nodiscard]] std::string frame_time_table(std::span<const recording::FrameEntry> frames);

/// Samples a second; 30 if there are fewer than two.
[[nodiscard]] double mean_rate_hz(std::int64_t first_ns, std::int64_t last_ns, std::size_t count);
[[nodiscard]] double frame_rate_hz(const recording::Recording& recording);
[[nodiscard]] double imu_rate_hz(const recording::Recording& recording);

}  // namespace fusebench::exports
