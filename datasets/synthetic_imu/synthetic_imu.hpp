// Synthetic IMU from ground truth, for recordings without an IMU. Only on request.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/recording/recording.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::synthetic_imu {

/// Errors that a simulated sensor adds to the true motion.
struct ImuSensor {
  std::string name;
  ImuNoise noise;
  double initial_gyroscope_bias_radps = 0;     ///< standard deviation per axis
  double initial_accelerometer_bias_mps2 = 0;  ///< standard deviation per axis
};

/// The IMU of an Intel RealSense ZR300 (Bosch BMI055). Noise: calibration file of the FMDataset authors
/// (covariances 5.88e-4, 1.22e-6, 4e-7, 2.5e-9). Initial biases: 0.004 rad/s (factory gyroscope offset of
/// that unit) and 0.05 m/s^2 (typical accelerometer residual after calibration).
[[nodiscard]] ImuSensor zr300_imu();

struct SyntheticImuOptions {
  ImuSensor sensor = zr300_imu();
  double rate_hz = 200;
  std::uint64_t seed = 1;
  Vector3d gravity_world_mps2{0, 0, -kGravity_mps2};  ///< TUM's motion-capture world has z up
  SplineFitOptions fit;
  /// Density of the acceleration error of the ground truth. On freiburg1_rpy the specific force of the spline
  /// and of the Kinect's accelerometer differ, below 5 Hz and without their means, by up to 0.5 m/s^2 rms per
  /// axis: 0.5 / sqrt(2 * 5 Hz) = 0.16.
  double truth_acceleration_mps2_sqrthz = 0.16;
};

/// Samples of an ideal IMU on the body of the spline: angular velocity and specific force R^T (a - g), from
/// start_ns to at least end_ns, at a fixed rate.
[[nodiscard]] std::vector<ImuSample> ideal_imu(const PoseSpline& spline, std::int64_t start_ns,
                                               std::int64_t end_ns, double rate_hz,
                                               const Vector3d& gravity_world_mps2);

/// Biases of an IMU at an instant, in its own axes.
struct ImuBias {
  Vector3d gyroscope_radps = Vector3d::Zero();
  Vector3d accelerometer_mps2 = Vector3d::Zero();
};

/// Adds an initial bias, random walks of the biases and white noise. Deterministic for a seed. Returns the
/// bias of each sample.
std::vector<ImuBias> add_imu_noise(std::vector<ImuSample>& samples, const ImuSensor& sensor, double rate_hz,
                                   std::uint64_t seed);

/// White-noise densities that represent the uncertainty of the ground truth.
///
/// Gyroscope: the orientation error of the fit has an rms r per axis (of the residuals) and is bounded, so
/// the rotation over any interval has the error sqrt(2) r. White noise of density n has the error n sqrt(T)
/// after T. Both are equal at the horizon T = 1 s over which the filter depends on the prior (fast motion,
/// blur); white noise is too small over shorter intervals and too large over longer ones:
/// n_gyroscope = sqrt(2) r / sqrt(1 s).
/// With T as one correlation time of the fit (42 ms), the gyroscope would be five times noisier than it is
/// over a second, and the filter would follow slow drifts of the visual measurements against a more accurate
/// prior.
///
/// Accelerometer: options.truth_acceleration_mps2_sqrthz. The residuals of the positions (0.1 mm) give little
/// information, since the main error is the mounting of the camera, not jitter.
[[nodiscard]] ImuNoise truth_noise(const SplineFit& fit, const SyntheticImuOptions& options);

/// Replaces the IMU of a recording by one synthesised from its ground truth, in the axes of the colour camera
/// at the reference point of the ground truth (T_imu_camera: recording::ground_truth_offset_m()). Sets imu,
/// imu_source, imu_note, and in the rig T_imu_camera and imu_noise (root sum of squares of the sensor's noise
/// and the uncertainty of the fit). Motion in gaps of the ground truth is the smoothest one, with a warning.
/// Call it after select_frames(). Errors: configuration (an option out of range), data_missing (no ground
/// truth), data_corrupt (frames outside the time of the ground truth, or the fit failed).
[[nodiscard]] Result<void> add_synthetic_imu(recording::Recording& recording,
                                             const SyntheticImuOptions& options = {});

}  // namespace fusebench::synthetic_imu
