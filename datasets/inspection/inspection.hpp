// Quality checks of a recording before use: measures stamps, images, depth, motion, IMU and calibration, and
// reports faults.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/parallel.hpp"
#include "datasets/inspection/finding.hpp"
#include "datasets/inspection/measures/registration_fit.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::inspection {

/// Times of one list.
struct StampMeasurement {
  std::size_t count = 0;
  double duration_s = 0;
  double rate_hz = 0;  ///< of the intervals, gaps filled; 0 for disordered stamps
  double median_interval_s = 0;
  double min_interval_s = 0;
  double max_interval_s = 0;
  double jitter_rms_s = 0;     ///< of the intervals about their median, pauses left out
  std::size_t duplicates = 0;  ///< equal to the stamp before
  std::size_t backwards = 0;   ///< earlier than the stamp before
  std::size_t gaps = 0;        ///< intervals of at least 1.75 medians
  std::size_t missing = 0;     ///< entries that would fill the gaps
};

struct AssociationMeasurement {
  double median_s = 0;      ///< of |depth stamp - colour stamp|
  double max_s = 0;         ///< of the same
  std::size_t reused = 0;   ///< frames with the depth image of the frame before
  std::size_t repeats = 0;  ///< frames whose colour file has the bytes of the one before
  std::size_t frozen = 0;   ///< the same of depth
};

/// One sampled frame.
struct FrameStatistics {
  std::size_t frame = 0;
  double time_s = 0;           ///< from the first frame
  double mean_grey = 0;        ///< 0 to 255
  double saturated_share = 0;  ///< of pixels at 250 and above
  double dark_share = 0;       ///< of pixels at 5 and below
  double sharpness = 0;        ///< variance of the Laplacian (4 neighbours), grey levels^2
  double depth_coverage = 0;   ///< share of pixels with a measurement
  double depth_median_m = 0;   ///< of measured pixels, as all below
  double depth_p05_m = 0;
  double depth_p95_m = 0;
  double depth_max_m = 0;
};

/// Of all sampled frames together.
struct DepthMeasurement {
  double coverage_median = 0;
  double coverage_min = 0;
  double median_m = 0;
  double min_m = 0;
  double max_m = 0;
  double beyond_10m_share = 0;           ///< of measured pixels
  double below_quarter_metre_share = 0;  ///< of measured pixels
  std::vector<std::uint64_t> histogram;  ///< bins of kDepthBin_m; the last one holds all that is farther
};
inline constexpr double kDepthBin_m = 0.1;
inline constexpr std::size_t kDepthBins = 121;

struct ExposureMeasurement {
  double mean_grey = 0;        ///< median over frames
  double saturated_share = 0;  ///< median over frames
  double dark_share = 0;       ///< median over frames
  double drift_grey = 0;       ///< range of the mean brightness, smoothed over a second
  double sharpness_median = 0;
  double sharpness_p05 = 0;
};

/// Speeds around one frame, over the interval from the frame before to the one after.
struct SpeedSample {
  std::size_t frame = 0;
  double time_s = 0;
  double angular_radps = 0;
  std::optional<double> linear_mps;  ///< from ground truth only
  double blur_px = 0;                ///< predicted, see MotionMeasurement
};

/// Blur is predicted as exposure * fx * (angular speed + linear speed / median depth) for an exposure of 10
/// ms. The paper calls motion slow that makes no blur, and fast that makes severe blur (Sec. 4, "All datasets
/// are divided ..."), without a number. Here a frame is blurred severely if its blur is as long as one of the
/// paper's patches is wide (10 pixels), and a recording is fast if that holds for a twentieth of its frames.
struct MotionMeasurement {
  std::string source;  ///< "ground truth", "gyroscope", or empty: no source
  std::vector<SpeedSample> speeds;
  double angular_mean_radps = 0;
  double angular_p95_radps = 0;
  double angular_max_radps = 0;
  std::optional<double> linear_mean_mps;
  std::optional<double> linear_p95_mps;
  std::optional<double> linear_max_mps;
  double blur_median_px = 0;
  double blur_p95_px = 0;
  double severe_share = 0;  ///< of frames with at least kSevereBlur_px
  bool fast = false;
};
inline constexpr double kBlurExposure_s = 0.010;
inline constexpr double kSevereBlur_px = 10;
inline constexpr double kFastShare = 0.05;

struct TruthMeasurement {
  StampMeasurement stamps;
  double coverage = 0;  ///< share of frames with truth around them
  double path_m = 0;    ///< length of the path of the frames
};

struct ImuMeasurement {
  StampMeasurement stamps;
  double coverage = 0;  ///< share of frames with samples around them
  double gyroscope_max_radps = 0;
  double accelerometer_max_mps2 = 0;
  double specific_force_median_mps2 = 0;
  std::size_t longest_repeat = 0;  ///< samples in a row that are equal
  std::optional<double> gravity_mps2;
  std::optional<Vector3d> gyroscope_bias_radps;
  std::optional<Vector3d> accelerometer_bias_mps2;
  double accelerometer_unit = 1;  ///< factor from the accelerometer's values to m/s^2; 0 if it is not known
  /// Signed permutation P: the accelerometer measures P f, with f in the axes that T_imu_camera describes.
  Matrix3d accelerometer_axes = Matrix3d::Identity();
  double gyroscope_unit = 1;   ///< factor from the gyroscope's values to rad/s; 0 if it is not known
  std::string gravity_source;  ///< "at rest" or "ground truth"
  std::string bias_source;     ///< of the gyroscope: "at rest", "ground truth", "images"
};

/// Rates over one interval, as they are compared.
struct TurnRate {
  double time_s = 0;  ///< the interval's middle, from the first frame
  double camera_radps = 0;
};

/// Time offset and rotation of the IMU relative to the camera. The turn of the camera over an interval, known
/// from ground truth or measured in the images, is compared with the integral of the gyroscope.
struct ImuAlignment {
  std::string source;  ///< "ground truth" or "images"
  std::size_t intervals = 0;
  double time_offset_s = 0;                  ///< IMU's stamp minus camera's stamp of one instant
  double time_offset_sigma_s = 0;            ///< standard deviation from the residuals
  std::optional<double> rotation_error_rad;  ///< from the best rotation to the calibration's, unless mirrored
  double rotation_sigma_rad = 0;             ///< of the worst axis
  Matrix3d rotation_imu_camera = Matrix3d::Identity();  ///< the best; determinant -1 if the axes are mirrored
  /// Signed permutation P: the gyroscope measures P w, with w in the axes that T_imu_camera describes.
  Matrix3d axes = Matrix3d::Identity();
  double axes_ratio = 1;    ///< rms residual with P, divided by that of the axes as calibrated
  bool axes_unique = true;  ///< no other permutation fits nearly as well
  double scale = 1;         ///< gyroscope's turns divided by the camera's
  Vector3d gyroscope_bias_radps = Vector3d::Zero();
  double residual_radps = 0;  ///< rms of the difference of the rates
  double explained = 0;       ///< share of the variance of the gyroscope's turns
  std::vector<TurnRate> rates;
};

/// Time offset and rotation of the IMU by the turns that the images show, whatever ground truth there is.
/// Nothing where the turns of the images do not explain those of the gyroscope.
[[nodiscard]] std::optional<ImuAlignment> align_imu_with_images(const recording::Recording& recording,
                                                                const Workers& workers);

/// One pair of frames, warped by ground truth.
struct ReprojectionPair {
  std::size_t from = 0;
  std::size_t to = 0;
  double rotation_rad = 0;
  double translation_m = 0;
  double depth_residual_m = 0;         ///< median |observed - predicted|
  double depth_residual_share = 0;     ///< the same, divided by the depth
  double intensity_residual_grey = 0;  ///< median |difference|
  double overlap = 0;                  ///< share of points that fall on a measurement
};

/// A way in which the recording may have been misread, and how much better it fits.
struct HypothesisResult {
  std::string code;  ///< of the finding that it would be
  std::string name;
  double value = 0;   ///< of the fitted parameter: a scale factor or seconds; else 0
  double factor = 1;  ///< geometric mean of the ratios of its residuals to those of the recording as it is
  double wins = 0;    ///< share of pairs in which it is better
};

struct ReprojectionMeasurement {
  std::vector<ReprojectionPair> pairs;
  double depth_residual_m = 0;  ///< medians over the pairs
  double depth_residual_share = 0;
  double intensity_residual_grey = 0;
  double static_factor = 1;  ///< residuals with no motion at all, divided by those with the ground truth
  std::vector<HypothesisResult> hypotheses;
};

/// The whole result. Severe findings first.
struct Inspection {
  std::string recording;
  std::string format;
  std::string fingerprint;
  std::size_t frames = 0;
  recording::ImuSource imu_source = recording::ImuSource::none;
  std::vector<Finding> findings;
  StampMeasurement color_stamps;
  StampMeasurement depth_stamps;
  AssociationMeasurement association;
  std::vector<FrameStatistics> images;  ///< the sampled frames
  ExposureMeasurement exposure;
  DepthMeasurement depth;
  std::optional<measures::RegistrationFit> registration;  ///< nothing where depth has too few edges
  std::optional<TruthMeasurement> truth;
  MotionMeasurement motion;
  std::optional<ImuMeasurement> imu;
  std::optional<ImuAlignment> imu_alignment;
  std::optional<ReprojectionMeasurement> reprojection;

  /// The code must be one of finding_codes().
  void add(std::string_view code, Severity severity, std::string message, std::string hint = {});
  [[nodiscard]] bool has(std::string_view code) const;
  [[nodiscard]] std::size_t count(Severity severity) const;
};

struct InspectOptions {
  std::optional<std::size_t> expected_frames;  ///< that the whole recording is published with
  std::size_t image_samples = 240;             ///< frames whose images are measured, spread evenly
  std::size_t pair_samples = 24;               ///< pairs of frames that are warped by ground truth
  std::size_t turn_samples = 180;  ///< pairs of neighbours in which turns are measured, without ground truth
};

/// Never fails: what cannot be read is a finding. The same result for any number of threads.
[[nodiscard]] Inspection inspect(const recording::Recording& recording, const Workers& workers,
                                 const InspectOptions& options = {});

/// The inspection of a recording that its reader refused.
[[nodiscard]] Inspection refused_inspection(const std::string& recording, const std::string& format,
                                            const Error& error);

}  // namespace fusebench::inspection
