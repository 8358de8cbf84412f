#include "eval/run/batch_estimation/calibration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/solvers.hpp"
#include "core/config/config.hpp"
#include "core/estimator/prediction/imu_preintegration.hpp"
#include "eval/run/batch_estimation/measured_motion.hpp"
#include "eval/run/preparation/sensor_timing.hpp"

namespace fusebench::batch_estimation {

namespace {

/// How much the noise of the IMU is exaggerated, round by round. With 100 the prior is a first guess only,
/// good for a calibration that is off by degrees; with 20 it steadies the poses and pulls them by little.
double exaggeration(int round) { return round == 0 ? 100.0 : 20.0; }

Matrix6d extrinsic_covariance(const smoother::BatchEstimate& estimate) {
  return estimate.common_covariance.block<6, 6>(smoother::kCommonRotation, smoother::kCommonRotation);
}

double offset_variance(const smoother::BatchEstimate& estimate) {
  return estimate.common_covariance(smoother::kCommonTimeOffset, smoother::kCommonTimeOffset);
}

/// What one round starts from and the next one improves.
struct Guess {
  SE3 T_imu_camera;
  double time_offset_s = 0;  ///< on top of the recording's, which the reader has taken out
  smoother::SensorScales scales;
  Vector3d timing_s = Vector3d::Zero();  ///< read-out of colour, of depth, delay of depth
};

Vector3d timing_sigma_s(const smoother::BatchEstimate& estimate) {
  return estimate.common_covariance.diagonal().segment<3>(smoother::kCommonTiming).cwiseSqrt();
}

/// As if the round had found all that is missing.
void complete_timing(const Vector3d& share, smoother::BatchEstimate& estimate) {
  for (int i = 0; i < 3; ++i) {
    estimate.timing_s[i] /= share[i];
    estimate.common_covariance.row(smoother::kCommonTiming + i) /= share[i];
    estimate.common_covariance.col(smoother::kCommonTiming + i) /= share[i];
  }
}

/// Adds what is the same in all frames and therefore shows nowhere: patches, depth and model lie together to
/// a quarter of a pixel only. Seen as an error of the delay, that is the angle over the rate of turning;
/// read-outs show as differences between rows, which are within sqrt(1/12) of an image from its middle (root
/// mean square).
void add_misalignment(const PinholeCamera& camera, const Vector3d& prior_s,
                      smoother::BatchEstimate& estimate) {
  constexpr double kMisalignment_px = 0.25;
  constexpr double kLeastRate_radps = 1e-3;
  double squared_rate = 0;
  for (const smoother::BatchFrame& frame : estimate.frames)
    squared_rate += frame.state.angular_velocity_imu_radps.squaredNorm();
  const double rate_radps =
      std::max(kLeastRate_radps, std::sqrt(squared_rate / static_cast<double>(estimate.frames.size())));
  const double delay_s = kMisalignment_px / camera.fx_px / rate_radps;
  const double readout_s = std::sqrt(12.0) * delay_s;
  const Vector3d common_s(readout_s, readout_s, delay_s);
  for (int i = 0; i < 3; ++i) {
    if (!(prior_s[i] > 0)) continue;
    double& variance = estimate.common_covariance(smoother::kCommonTiming + i, smoother::kCommonTiming + i);
    variance = std::max(variance, std::min(prior_s[i] * prior_s[i], variance + common_s[i] * common_s[i]));
  }
}

bool moved_little(const smoother::BatchEstimate& estimate, const Guess& guess) {
  constexpr double kShare = 0.5;  // of the standard deviation
  Eigen::Matrix<double, smoother::kBatchCommonSize - smoother::kCommonRotation, 1> change;
  change << pose_minus(estimate.T_imu_camera, guess.T_imu_camera),
      estimate.time_offset_s - guess.time_offset_s, estimate.scales.gyroscope - guess.scales.gyroscope,
      estimate.scales.accelerometer - guess.scales.accelerometer, estimate.timing_s;
  const auto sigma = estimate.common_covariance.diagonal().tail(change.size()).cwiseSqrt();
  return (change.cwiseAbs().array() <= kShare * sigma.array()).all();
}

/// The recording as it is if this guess is right.
recording::Recording with_guess(const recording::Recording& original, const Guess& guess, bool hold_timing) {
  recording::Recording recording = original;
  recording.rig.T_imu_camera = guess.T_imu_camera;
  const auto shift_ns = static_cast<std::int64_t>(std::llround(1e9 * guess.time_offset_s));
  for (ImuSample& sample : recording.imu) {
    sample = prediction::corrected(sample, {.gyroscope_scale = guess.scales.gyroscope,
                                            .accelerometer_scale = guess.scales.accelerometer});
    sample.timestamp_ns -= shift_ns;
  }
  SensorTiming timing = recording.rig.timing;
  timing.color_readout_s = guess.timing_s[0];
  timing.depth_readout_s = guess.timing_s[1];
  timing.depth_delay_s = guess.timing_s[2];
  if (hold_timing)
    timing.color_readout_sigma_s = timing.depth_readout_sigma_s = timing.depth_delay_sigma_s = 0;
  recording::set_timing(recording, timing);
  return recording;
}

/// Directions in which the posterior is at least half as wide as the prior.
void find_undetermined(const smoother::BatchEstimate& estimate, const smoother::BatchOptions& options,
                       std::vector<Undetermined>& found) {
  constexpr double kShare = 0.5;
  struct Part {
    const char* name;
    int place;
    double prior;
  };
  for (const Part& part :
       {Part{"rotation", smoother::kCommonRotation, options.rotation_prior_rad},
        Part{"translation", smoother::kCommonTranslation, options.translation_prior_m},
        Part{"gyroscope_scale", smoother::kCommonGyroscopeScale, options.gyroscope_scale_prior},
        Part{"accelerometer_scale", smoother::kCommonAccelerometerScale,
             options.accelerometer_scale_prior}}) {
    if (!(part.prior > 0)) continue;
    const Matrix3d covariance = estimate.common_covariance.block<3, 3>(part.place, part.place);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
    for (int i = 2; i >= 0; --i) {
      const double sigma = std::sqrt(std::max(0.0, eigen.eigenvalues()[i]));
      if (sigma < kShare * part.prior) break;
      Vector3d direction = eigen.eigenvectors().col(i);
      Eigen::Index largest = 0;
      direction.cwiseAbs().maxCoeff(&largest);
      if (direction[largest] < 0) direction = -direction;
      found.push_back({part.name, direction, sigma});
    }
  }
  for (const Part& part : {Part{"time_offset", smoother::kCommonTimeOffset, options.time_offset_prior_s},
                           Part{"color_readout", smoother::kCommonTiming, options.timing_prior_s[0]},
                           Part{"depth_readout", smoother::kCommonTiming + 1, options.timing_prior_s[1]},
                           Part{"depth_delay", smoother::kCommonTiming + 2, options.timing_prior_s[2]}}) {
    const double sigma_s = std::sqrt(estimate.common_covariance(part.place, part.place));
    if (part.prior > 0 && sigma_s >= kShare * part.prior)
      found.push_back({part.name, Vector3d::Zero(), sigma_s});
  }
}

/// The scales around those that the reader has taken out.
Known<Vector3d> scale_of(const Vector3d& read_with, const Vector3d& error,
                         const smoother::BatchCommonMatrix& covariance, int place) {
  return {read_with.cwiseProduct(Vector3d::Ones() + error),
          read_with.cwiseProduct(covariance.diagonal().segment<3>(place).cwiseSqrt())};
}

void describe_sensors(const smoother::BatchEstimate& estimate, const Guess& guess,
                      const calibration::ImuCalibration& told, CameraImuCalibration& result) {
  result.gyroscope_scale = scale_of(told.gyroscope_scale, estimate.scales.gyroscope,
                                    estimate.common_covariance, smoother::kCommonGyroscopeScale);
  result.accelerometer_scale = scale_of(told.accelerometer_scale, estimate.scales.accelerometer,
                                        estimate.common_covariance, smoother::kCommonAccelerometerScale);
  const Vector3d timing_s = guess.timing_s + estimate.timing_s;
  const Vector3d sigma_s = timing_sigma_s(estimate);
  result.timing = {timing_s[0], timing_s[1], timing_s[2], sigma_s[0], sigma_s[1], sigma_s[2]};
  result.timing_variance_factor = estimate.timing_variance_factor;
  result.timing_correlation_factor = estimate.timing_correlation_factor;
}

void describe(const smoother::BatchEstimate& estimate, const smoother::BatchOptions& options,
              CameraImuCalibration& result) {
  result.T_imu_camera = estimate.T_imu_camera;
  result.time_offset_s = result.time_offset_before_s + estimate.time_offset_s;
  result.extrinsic_covariance = extrinsic_covariance(estimate);
  result.time_offset_sigma_s = std::sqrt(offset_variance(estimate));
  result.rotation_change_rad =
      so3_log(result.T_imu_camera_before.rotation.conjugate() * estimate.T_imu_camera.rotation);
  const smoother::BatchFrame& middle = estimate.frames[estimate.frames.size() / 2];
  const auto sigma = [&](int offset) -> Vector3d {
    return middle.covariance.diagonal().segment<3>(offset).cwiseSqrt();
  };
  result.gyroscope_bias_radps = {middle.state.gyroscope_bias_radps, sigma(filter::kGyroscopeBias)};
  result.accelerometer_bias_mps2 = {middle.state.accelerometer_bias_mps2, sigma(filter::kAccelerometerBias)};
  const SE3 T_world_camera = estimate.frames.front().state.T_world_imu * estimate.T_imu_camera;
  result.gravity_direction_camera = T_world_camera.rotation.conjugate() * estimate.gravity_direction_world;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> gravity(
      estimate.common_covariance.block<2, 2>(smoother::kCommonGravity, smoother::kCommonGravity));
  result.gravity_sigma_rad = std::sqrt(std::max(0.0, gravity.eigenvalues()[1]));
  result.variance_factor = estimate.variance_factor;
  result.correlation_factor = estimate.correlation_factor;
  result.inertial_variance_factor = estimate.inertial_variance_factor;
  result.outliers = estimate.outliers;
  result.undetermined.clear();
  find_undetermined(estimate, options, result.undetermined);
}

/// The priors are around what the recording says, and the unknowns around the guess.
smoother::BatchOptions batch_options(const recording::Recording& recording, const CalibrationOptions& options,
                                     const Guess& guess) {
  smoother::BatchOptions batch;
  batch.rotation_prior_rad = options.rotation_prior_rad;
  batch.translation_prior_m = options.translation_prior_m;
  batch.time_offset_prior_s = options.time_offset_prior_s;
  batch.T_imu_camera_expected = recording.rig.T_imu_camera;
  batch.time_offset_expected_s = 0;
  const double scale_prior = recording.rig.imu_axes_are_exact ? 0.0 : options.scale_prior;
  batch.gyroscope_scale_prior = scale_prior;
  batch.accelerometer_scale_prior = scale_prior;
  const preparation::TimingEstimate timing = preparation::timing_of(recording.rig.timing);
  batch.timing_prior_s = timing.sigma_s;
  batch.timing_expected_s = timing.value_s - guess.timing_s;
  return batch;
}

/// Read-outs within the bounds of a calibration: the estimate of one that is about 0 may be below 0.
SensorTiming possible_timing(SensorTiming timing) {
  for (double* const readout_s : {&timing.color_readout_s, &timing.depth_readout_s})
    *readout_s = std::clamp(*readout_s, 0.0, calibration::kMostReadout_s);
  return timing;
}

}  // namespace

Result<CameraImuCalibration> calibrate(const recording::Recording& recording, const config::Config& config,
                                       const CalibrationOptions& options, const Workers& workers,
                                       const run::RunControl& control) {
  check(options.max_rounds >= 2, "the first round is no result");
  CameraImuCalibration result;
  calibration::ImuCalibration told;
  if (recording.imu_source == recording::ImuSource::recorded && recording.calibration &&
      recording.calibration->imu)
    told = *recording.calibration->imu;
  result.T_imu_camera_before = recording.rig.T_imu_camera;
  result.time_offset_before_s = told.time_offset_s;
  result.timing_before = recording.rig.timing;
  Guess guess{recording.rig.T_imu_camera, 0, {}, preparation::timing_of(recording.rig.timing).value_s};
  // The model and the patches are made of images of the same timing and take a part of its error with them,
  // so that a round finds less than is missing: of the read-out of colour about a half.
  preparation::TimingResponse response(0.4);
  for (int round = 0; round < options.max_rounds && !result.converged; ++round) {
    const recording::Recording guessed = with_guess(recording, guess, round > 0);
    config::Config exaggerated = config;
    exaggerated.motion.imu_noise_factor *= exaggeration(round);
    auto measured = measure_motion(guessed, exaggerated, workers, control);
    if (!measured) return tl::unexpected(measured.error());
    smoother::BatchInput& input = measured->input;
    input.imu = recording.imu;
    input.time_offset_s = guess.time_offset_s;
    input.scales = guess.scales;
    const smoother::BatchOptions batch = batch_options(recording, options, guess);
    auto estimate = smoother::estimate_batch(input, batch);
    if (!estimate) return tl::unexpected(estimate.error());
    if (round > 0) response.take(guess.timing_s, estimate->timing_s, timing_sigma_s(*estimate));
    complete_timing(response.share(), *estimate);
    add_misalignment(recording.rig.camera, batch.timing_prior_s, *estimate);
    // A first round that found nothing to change has been measured loosely; the second one is the result.
    result.converged = round > 0 && moved_little(*estimate, guess);
    result.frames = measured->stamps_ns.size();
    result.tracked = measured->tracked;
    describe(*estimate, batch, result);
    describe_sensors(*estimate, guess, told, result);
    guess = {estimate->T_imu_camera, estimate->time_offset_s, estimate->scales,
             guess.timing_s + estimate->timing_s};
    result.rounds.push_back({exaggeration(round), result.T_imu_camera, result.time_offset_s, guess.timing_s});
  }
  return result;
}

Result<void> check_fit(const CameraImuCalibration& calibration, const recording::Recording& recording) {
  constexpr double kMostVariance = 100;
  std::vector<std::string> reasons;
  if (!calibration.converged)
    reasons.push_back(fmt::format("still moving after {} rounds", calibration.rounds.size()));
  if (2 * calibration.tracked < calibration.frames)
    reasons.push_back(fmt::format("{} of {} frames were tracked (required: half or more)",
                                  calibration.tracked, calibration.frames));
  if (!(calibration.variance_factor <= kMostVariance))
    reasons.push_back(
        fmt::format("image residuals have {:.0f} times the expected variance (allowed: up to {:g})",
                    calibration.variance_factor, kMostVariance));
  if (reasons.empty()) return {};
  return fail(
      ErrorCode::run_failed,
      fmt::format("recording '{}' does not determine a calibration: {}", recording.name,
                  fmt::join(reasons, "; ")),
      "pass more --rounds, or --frames A:B with frames that are tracked; docs/calibration.md describes "
      "how to move");
}

calibration::RigCalibration calibrated_rig(const recording::Recording& recording,
                                           const CameraImuCalibration& calibration) {
  check(recording.calibration.has_value(), "the recording's reader kept its calibration");
  calibration::RigCalibration rig = *recording.calibration;
  const Vector6d sigma = calibration.extrinsic_covariance.diagonal().cwiseSqrt();
  rig.imu = calibration::ImuCalibration{calibration.T_imu_camera, recording.rig.imu_noise,
                                        calibration.time_offset_s, calibration.gyroscope_scale.value,
                                        calibration.accelerometer_scale.value};
  rig.color.timing = possible_timing(calibration.timing);
  rig.source = fmt::format(
      "T_imu_color and time_offset_s by fusebench calibrate on {} frames of {} (standard deviations {:.3f} "
      "deg, {:.1f} mm, {:.2f} ms); the rest: {}",
      calibration.frames, recording.name, sigma.head<3>().maxCoeff() / radians(1.0),
      1e3 * sigma.tail<3>().maxCoeff(), 1e3 * calibration.time_offset_sigma_s,
      recording.calibration->source.empty() ? "no source given" : recording.calibration->source);
  return rig;
}

}  // namespace fusebench::batch_estimation
