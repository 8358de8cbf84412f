// All poses, velocities and biases of a recording at once, and if asked for the calibration of camera and
// IMU and of the sensors themselves, from inertial samples and relative camera motions measured by the
// images: a maximum a posteriori estimate.
//
// World is the camera of the first frame: the first pose is fixed. Unknowns of a frame: pose and velocity of
// the IMU, biases. Common unknowns: the direction of gravity, T_imu_camera, the offset of the IMU's clock,
// scales of its axes, and the timing of the image sensors. Samples are integrated again with each new offset,
// bias and scale until convergence.
//
// The noise scale of the visual motions is not known (the filter counts correlated pixels as few
// measurements), and errors of neighbouring frames are correlated. So the visual information is divided by
//
//   variance factor     sum of squared visual residuals / their redundancy (Helmert), times
//   correlation factor  1 + 2 sum of their autocorrelation over frames, up to the first lag below 0.05:
//                       what white noise must have to look alike over long times
//
// which are estimated in turns with the states; what the images of a frame say of the timing among themselves
// has factors of its own. The inertial noise is taken as given; its own variance factor
// is reported.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/filter/filter_state.hpp"
#include "core/smoother/relative_motion.hpp"

namespace fusebench::smoother {

inline constexpr int kBatchStateSize = 15;    ///< the error state's first five parts (StateOffset)
inline constexpr int kBatchCommonSize = 18;   ///< and of the common unknowns:
inline constexpr int kCommonGravity = 0;      ///< rad, tangent of S2
inline constexpr int kCommonRotation = 2;     ///< rad, right perturbation of R_imu_camera (camera frame)
inline constexpr int kCommonTranslation = 5;  ///< m, imu
inline constexpr int kCommonTimeOffset = 8;   ///< s
inline constexpr int kCommonGyroscopeScale = 9;
inline constexpr int kCommonAccelerometerScale = 12;
inline constexpr int kCommonTiming = 15;  ///< s: read-out of colour, read-out of depth, delay of depth
using BatchStateMatrix = Eigen::Matrix<double, kBatchStateSize, kBatchStateSize>;
using BatchCommonMatrix = Eigen::Matrix<double, kBatchCommonSize, kBatchCommonSize>;

/// Scale errors: what is measured is 1 + scale times the truth, by axis of the IMU.
struct SensorScales {
  Vector3d gyroscope = Vector3d::Zero();
  Vector3d accelerometer = Vector3d::Zero();
};

struct BatchInput {
  std::vector<std::int64_t> instants_ns;     ///< of the frames, on the camera's clock, increasing
  std::vector<filter::FilterState> initial;  ///< one a frame: where the search begins
  std::vector<RelativeCameraMotion> visual;  ///< in any order; lost frames have none
  std::vector<VisualTiming> timing;          ///< the same
  std::span<const ImuSample> imu;            ///< sorted; must outlive the call only
  ImuNoise imu_noise;
  SE3 T_imu_camera;          ///< where the search begins
  double time_offset_s = 0;  ///< the same for the IMU's clock minus the camera's
  SensorScales scales;       ///< the same
};

struct BatchOptions {
  /// Standard deviations of the priors; 0 holds the value fixed.
  double rotation_prior_rad = 0;
  double translation_prior_m = 0;
  double time_offset_prior_s = 0;
  double gyroscope_scale_prior = 0;  ///< these two: around 0
  double accelerometer_scale_prior = 0;
  Vector3d timing_prior_s = Vector3d::Zero();
  Vector3d timing_expected_s = Vector3d::Zero();
  /// The means of the first three; not given: where the search begins.
  std::optional<SE3> T_imu_camera_expected;
  std::optional<double> time_offset_expected_s;
  double gyroscope_bias_sigma_radps = 0.05;    ///< around 0, first frame
  double accelerometer_bias_sigma_mps2 = 0.3;  ///< the same
  double outlier_sigmas = 5.0;                 ///< Huber's, on the six residuals of a pair of frames
  int max_rounds = 12;                         ///< of integration and search
};

struct BatchFrame {
  filter::FilterState state;  ///< with gravity and the clock's offset, which are common
  /// Rotation, position, velocity and biases, in the tangent at the state.
  BatchStateMatrix covariance = BatchStateMatrix::Zero();
  double visual_residual = -1;  ///< rms of the normalised residuals of its image; negative without one
};

struct BatchEstimate {
  std::vector<BatchFrame> frames;
  SE3 T_imu_camera;
  double time_offset_s = 0;
  SensorScales scales;
  Vector3d timing_s = Vector3d::Zero();  ///< errors, as SensorErrors counts them
  Vector3d gravity_direction_world = Vector3d::UnitY();
  BatchCommonMatrix common_covariance = BatchCommonMatrix::Zero();  ///< what is held fixed has zeros
  double variance_factor = 1;
  double correlation_factor = 1;
  double timing_variance_factor = 1;     ///< these two: of what frames say of the timing
  double timing_correlation_factor = 1;  ///< the same
  double inertial_variance_factor = 1;   ///< 1 if the specified noise of the IMU is right
  std::size_t outliers = 0;              ///< images beyond outlier_sigmas
  int rounds = 0;
  bool converged = false;
};

/// One thread; depends on nothing but its arguments. Errors: configuration (an option out of range),
/// data_corrupt (fewer than three frames, no visual motion, frames or samples that do not fit, a search that
/// failed).
[[nodiscard]] Result<BatchEstimate> estimate_batch(const BatchInput& input, const BatchOptions& options);

}  // namespace fusebench::smoother
