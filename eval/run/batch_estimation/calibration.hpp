// Where the camera sits on the IMU, how far their clocks are apart, the scales of the IMU's axes and the
// timing of the image sensors, from a recording of motion.
//
// The pipeline runs over the recording with the noise of the IMU exaggerated, so that its poses are what the
// images say while the IMU only helps to find them; a wrong calibration then hardly pulls them. A batch
// estimate (core/estimator/smoother) of that run gives the calibration. The next round starts from it and
// exaggerates less, until nothing moves by more than half its standard deviation. The first round learns the
// timing as it goes, the later ones hold it, so that the whole model and all patches are of one timing.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/smoother/batch_estimate.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/run/run.hpp"

namespace fusebench::batch_estimation {

struct CalibrationOptions {
  double rotation_prior_rad = radians(10.0);  ///< standard deviations around the recording's calibration
  double translation_prior_m = 0.1;
  double time_offset_prior_s = 0.05;
  double scale_prior = 0.03;  ///< of the IMU's axes, around the recording's; that of timing is the rig's
  int max_rounds = 4;         ///< 2 or more: the first one is loose on purpose, and never the result
};

/// A value with its standard deviation.
template <class Value>
struct Known {
  Value value;
  Value sigma;
};

/// A direction in which the recording says little more than the prior.
struct Undetermined {
  /// "rotation", "translation", "gyroscope_scale", "accelerometer_scale"; "time_offset", "color_readout",
  /// "depth_readout", "depth_delay"
  std::string parameter;
  Vector3d direction = Vector3d::Zero();  ///< unit; of rotations in the camera's axes, else the IMU's
  double sigma = 0;                       ///< rad, m, 1 or s
};

struct CalibrationRound {
  double imu_noise_factor = 1;
  SE3 T_imu_camera;
  double time_offset_s = 0;
  Vector3d timing_s = Vector3d::Zero();  ///< read-out of colour, of depth, delay of depth
};

struct CameraImuCalibration {
  std::size_t frames = 0;
  std::size_t tracked = 0;
  SE3 T_imu_camera_before;
  double time_offset_before_s = 0;  ///< these two: IMU's stamp minus the images', as in calibration.toml
  SE3 T_imu_camera;
  double time_offset_s = 0;
  Matrix6d extrinsic_covariance = Matrix6d::Zero();  ///< rotation (right, camera axes), translation (imu)
  double time_offset_sigma_s = 0;
  SensorTiming timing_before;
  SensorTiming timing;                                    ///< with the new standard deviations; 0: held
  Known<Vector3d> gyroscope_scale;                        ///< 1: as it is; standard deviation 0: held
  Known<Vector3d> accelerometer_scale;                    ///< the same
  Vector3d rotation_change_rad = Vector3d::Zero();        ///< Log(before^-1 after), camera axes
  Known<Vector3d> gyroscope_bias_radps;                   ///< at the middle frame
  Known<Vector3d> accelerometer_bias_mps2;                ///< the same
  Vector3d gravity_direction_camera = Vector3d::UnitY();  ///< of the first frame
  double gravity_sigma_rad = 0;                           ///< in its worst direction
  double variance_factor = 1;
  double correlation_factor = 1;
  double timing_variance_factor = 1;  ///< these two: of what single frames say of the timing
  double timing_correlation_factor = 1;
  double inertial_variance_factor = 1;
  std::size_t outliers = 0;
  std::vector<CalibrationRound> rounds;
  bool converged = false;
  std::vector<Undetermined> undetermined;
};

/// The recording's IMU must be there, and the configuration's prior the IMU. Progress is of one round.
/// Errors: those of measure_motion() and estimate_batch().
[[nodiscard]] Result<CameraImuCalibration> calibrate(const recording::Recording& recording,
                                                     const config::Config& config,
                                                     const CalibrationOptions& options,
                                                     const Workers& workers, const run::RunControl& control);

/// Error run_failed: the rounds did not converge, fewer than half of the frames were tracked, or the variance
/// of the image residuals is more than 100 times that which the filter claims.
[[nodiscard]] Result<void> check_fit(const CameraImuCalibration& calibration,
                                     const recording::Recording& recording);

/// What the recording's files said with the new extrinsic, offset, timing and scales, ready for a file:
/// read-outs below 0 are 0. The recording as it was opened.
[[nodiscard]] calibration::RigCalibration calibrated_rig(const recording::Recording& recording,
                                                         const CameraImuCalibration& calibration);

/// For people, and for programs.
[[nodiscard]] std::string to_text(const CameraImuCalibration& calibration,
                                  const recording::Recording& recording);
[[nodiscard]] std::string to_json(const CameraImuCalibration& calibration,
                                  const recording::Recording& recording);

}  // namespace fusebench::batch_estimation
