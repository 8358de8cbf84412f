// An inertial sensor made from ground truth, for recordings that have none. Always asked for, never a
// default.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/types.hpp"
#include "datasets/pose_spline.hpp"
#include "datasets/recording.hpp"

namespace fusebench {

/// What a simulated sensor adds to the true motion.
struct ImuSensor {
  std::string name;
  ImuNoise noise;
  double initial_gyroscope_bias_radps = 0;     ///< standard deviation per axis
  double initial_accelerometer_bias_mps2 = 0;  ///< standard deviation per axis
};

/// The IMU of an Intel RealSense ZR300 (Bosch BMI055). Noise: the FMDataset authors' calibration file
/// (covariances 5.88e-4, 1.22e-6, 4e-7, 2.5e-9). Initial biases: of the size of that unit's factory gyroscope
/// offset (0.004 rad/s), and 0.05 m/s^2 as an accelerometer's rest after calibration.
[[nodiscard]] ImuSensor zr300_imu();

struct SyntheticImuOptions {
  ImuSensor sensor = zr300_imu();
  double rate_hz = 200;
  std::uint64_t seed = 1;
  Vector3d gravity_world_mps2{0, 0, -kGravity_mps2};  ///< TUM's motion-capture world has z up
  SplineFitOptions fit;
};

/// Samples of an ideal IMU that moves with the spline's body: angular velocity, and specific force R^T (a -
/// g). From start_ns to at least end_ns, at a fixed rate.
[[nodiscard]] std::vector<ImuSample> ideal_imu(const PoseSpline& spline, std::int64_t start_ns,
                                               std::int64_t end_ns, double rate_hz,
                                               const Vector3d& gravity_world_mps2);

/// Adds an initial bias, random walks of the biases and white noise. The same seed gives the same samples.
void add_imu_noise(std::vector<ImuSample>& samples, const ImuSensor& sensor, double rate_hz,
                   std::uint64_t seed);

/// White-noise densities that are equivalent to the fit's uncertainty.
///
/// The residuals hold the truth's jitter and the motion that smoothing took away, and the data do not tell
/// them apart. So the error of the spline is taken to have the residuals' whole rms r (per axis) and, as it
/// cannot vary faster than the fit, a flat spectrum up to the cutoff B; it is then independent after tau = 1
/// / (2 B). The orientation error of an interval is sqrt(2) r, that of a gyroscope of density n after tau is
/// n sqrt(tau), hence
///   n_gyroscope = sqrt(2) r_rotation / sqrt(tau).
/// The velocity error has the rms r 2 pi B / sqrt(3), so in the same way
///   n_accelerometer = sqrt(2) (2 pi B / sqrt(3)) r_position / sqrt(tau).
/// Over longer times these exaggerate: the error of the fit stays bounded and does not walk.
[[nodiscard]] ImuNoise fit_noise(const SplineFit& fit, const SplineFitOptions& options);

/// Gives a recording an IMU that is made from its ground truth, in the colour camera's axes (T_imu_camera =
/// identity), in place of any other. Sets imu, imu_source, imu_note, and in the rig T_imu_camera and
/// imu_noise (the sensor's noise and the fit's uncertainty, root of the sum of squares). Motion in gaps of
/// the truth is the smoothest one, with a warning. Call it after select_frames(). Errors: configuration (an
/// option out of range), data_missing (no ground truth), data_corrupt (frames outside of the truth's time, or
/// the fit failed).
[[nodiscard]] Result<void> add_synthetic_imu(Recording& recording, const SyntheticImuOptions& options = {});

}  // namespace fusebench
