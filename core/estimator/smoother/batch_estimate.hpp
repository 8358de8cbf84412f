// Batch estimator: maximum a posteriori estimate of all poses, velocities and biases of a recording and, if
// requested, of the calibration of camera, IMU and sensors, from inertial samples and relative camera motions
// measured by the images.
//
// World is the camera frame of the first frame; the first pose is fixed. Unknowns of a frame: pose and
// velocity of the IMU, biases. Common unknowns: gravity direction, T_imu_camera, IMU clock offset, scales of
// the IMU axes, timing of the image sensors. Samples are integrated again at each new offset, bias and scale
// until convergence.
//
// The noise scale of the visual motions is unknown (the filter counts correlated pixels as few measurements),
// and errors of neighbouring frames are correlated. The visual information is therefore divided by the
// product of
//
// - variance factor: sum of squared visual residuals / their redundancy (Helmert)
// - correlation factor: 1 + 2 * sum of their autocorrelations over frames, up to the first lag below 0.05
//
// Both are estimated alternately with the states. The timing residuals have their own factors. The inertial
// noise is taken from the specification; its variance factor is reported.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/estimator/filter/filter_state.hpp"
#include "core/estimator/smoother/relative_motion.hpp"

namespace fusebench::smoother {

inline constexpr int kBatchStateSize = 15;    ///< rotation, position, velocity and biases of StateOffset
inline constexpr int kBatchCommonSize = 18;   ///< size of the common unknowns, with the following offsets
inline constexpr int kCommonGravity = 0;      ///< rad, tangent of S2
inline constexpr int kCommonRotation = 2;     ///< rad, right perturbation of R_imu_camera (camera frame)
inline constexpr int kCommonTranslation = 5;  ///< m, imu
inline constexpr int kCommonTimeOffset = 8;   ///< s
inline constexpr int kCommonGyroscopeScale = 9;
inline constexpr int kCommonAccelerometerScale = 12;
inline constexpr int kCommonTiming = 15;  ///< s: read-out of colour, read-out of depth, delay of depth
using BatchStateMatrix = Eigen::Matrix<double, kBatchStateSize, kBatchStateSize>;
using BatchCommonMatrix = Eigen::Matrix<double, kBatchCommonSize, kBatchCommonSize>;

/// Scale errors: measurement = (1 + scale) * true value, by axis of the IMU.
struct SensorScales {
  Vector3d gyroscope = Vector3d::Zero();
  Vector3d accelerometer = Vector3d::Zero();
};

struct BatchInput {
  std::vector<std::int64_t> instants_ns;     ///< of the frames, on the camera's clock, increasing
  std::vector<filter::FilterState> initial;  ///< one for each frame: start of the search
  std::vector<RelativeCameraMotion> visual;  ///< in any order; lost frames have none
  std::vector<VisualTiming> timing;          ///< in any order; lost frames have none
  std::span<const ImuSample> imu;            ///< sorted; must outlive the call only
  ImuNoise imu_noise;
  SE3 T_imu_camera;          ///< start of the search
  double time_offset_s = 0;  ///< IMU clock minus camera clock: start of the search
  SensorScales scales;       ///< start of the search
};

struct BatchOptions {
  /// Standard deviations of the priors; 0 holds the value fixed.
  double rotation_prior_rad = 0;
  double translation_prior_m = 0;
  double time_offset_prior_s = 0;
  double gyroscope_scale_prior = 0;  ///< prior mean 0, as for accelerometer_scale_prior
  double accelerometer_scale_prior = 0;
  Vector3d timing_prior_s = Vector3d::Zero();
  Vector3d timing_expected_s = Vector3d::Zero();
  /// Means of the first three priors; default: start of the search.
  std::optional<SE3> T_imu_camera_expected;
  std::optional<double> time_offset_expected_s;
  double gyroscope_bias_sigma_radps = 0.05;    ///< around 0, first frame
  double accelerometer_bias_sigma_mps2 = 0.3;  ///< around 0, first frame
  double outlier_sigmas = 5.0;  ///< scale of Huber's loss on the six residuals of a pair of frames
  int max_rounds = 12;          ///< of integration and search
};

struct BatchFrame {
  filter::FilterState state;  ///< includes gravity and clock offset, which are common
  /// Rotation, position, velocity and biases, in the tangent at the state.
  BatchStateMatrix covariance = BatchStateMatrix::Zero();
  double visual_residual = -1;  ///< rms of the normalised residuals of the image; negative without an image
};

struct BatchEstimate {
  std::vector<BatchFrame> frames;
  SE3 T_imu_camera;
  double time_offset_s = 0;
  SensorScales scales;
  Vector3d timing_s = Vector3d::Zero();  ///< errors, as SensorErrors::timing_s()
  Vector3d gravity_direction_world = Vector3d::UnitY();
  BatchCommonMatrix common_covariance = BatchCommonMatrix::Zero();  ///< zeros for fixed values
  double variance_factor = 1;
  double correlation_factor = 1;
  double timing_variance_factor = 1;     ///< of the timing residuals of frames
  double timing_correlation_factor = 1;  ///< of the timing residuals of frames
  double inertial_variance_factor = 1;   ///< 1 if the specified noise of the IMU is correct
  std::size_t outliers = 0;              ///< images beyond outlier_sigmas
  int rounds = 0;
  bool converged = false;
};

/// Runs in one thread; deterministic. Errors: configuration (an option out of range), data_corrupt (fewer
/// than three frames, no visual motion, frames or samples that do not fit, a search that failed).
[[nodiscard]] Result<BatchEstimate> estimate_batch(const BatchInput& input, const BatchOptions& options);

}  // namespace fusebench::smoother
