// An inertial sensor made from ground truth, for recordings that have none. Only on request, never a default.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/recording/recording.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::synthetic_imu {

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
  /// Density of the error of accelerations from the truth. On freiburg1_rpy the spline's specific force and
  /// the Kinect's own accelerometer differ, below 5 Hz and about their means, by up to 0.5 m/s^2 rms per
  /// axis: 0.5 / sqrt(2 * 5 Hz) = 0.16.
  double truth_acceleration_mps2_sqrthz = 0.16;
};

/// Samples of an ideal IMU that moves with the spline's body: angular velocity, and specific force R^T (a -
/// g). From start_ns to at least end_ns, at a fixed rate.
[[nodiscard]] std::vector<ImuSample> ideal_imu(const PoseSpline& spline, std::int64_t start_ns,
                                               std::int64_t end_ns, double rate_hz,
                                               const Vector3d& gravity_world_mps2);

/// The biases of an IMU at one time, in its own axes.
struct ImuBias {
  Vector3d gyroscope_radps = Vector3d::Zero();
  Vector3d accelerometer_mps2 = Vector3d::Zero();
};

/// Adds an initial bias, random walks of the biases and white noise. The same seed gives the same samples.
/// Returns the bias of each sample.
std::vector<ImuBias> add_imu_noise(std::vector<ImuSample>& samples, const ImuSensor& sensor, double rate_hz,
                                   std::uint64_t seed);

/// White-noise densities that stand for the uncertainty of the truth that an IMU is made from.
///
/// Gyroscope: the orientation error of the fit has about the residuals' rms r per axis and stays bounded, so
/// the turn over any interval is off by sqrt(2) r. White noise of density n is off by n sqrt(T) after T. The
/// two agree at the horizon T = 1 s over which the filter has to rely on the prior (fast motion, blur); over
/// shorter times white noise claims too much, over longer ones too little:
///   n_gyroscope = sqrt(2) r / sqrt(1 s).
/// Taking T as one correlation time of the fit instead (42 ms) makes the gyroscope five times noisier than it
/// is over a second, and the filter would then follow slow drifts of the visual measurements against a more
/// accurate prior.
///
/// Accelerometer: options.truth_acceleration_mps2_sqrthz. The residuals of the positions (0.1 mm) say little
/// about it, since the error is that of the truth's mounting on the camera rather than jitter.
[[nodiscard]] ImuNoise truth_noise(const SplineFit& fit, const SyntheticImuOptions& options);

/// Gives a recording an IMU that is made from its ground truth, in the colour camera's axes, at the point
/// that the ground truth is of (T_imu_camera: recording::ground_truth_offset_m()), in place of any other.
/// Sets imu, imu_source, imu_note, and in the rig T_imu_camera and imu_noise (the sensor's noise and the
/// fit's uncertainty, root of the sum of squares). Motion in gaps of the truth is the smoothest one, with a
/// warning. Call it after select_frames(). Errors: configuration (an option out of range), data_missing (no
/// ground truth), data_corrupt (frames outside of the truth's time, or the fit failed).
[[nodiscard]] Result<void> add_synthetic_imu(recording::Recording& recording,
                                             const SyntheticImuOptions& options = {});

}  // namespace fusebench::synthetic_imu
