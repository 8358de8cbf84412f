#include "eval/batch_estimation/calibration.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "eval/batch_estimation/measured_motion.hpp"

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

bool moved_little(const smoother::BatchEstimate& estimate, const SE3& T_imu_camera, double time_offset_s) {
  constexpr double kShare = 0.5;  // of the standard deviation
  const Vector6d change = pose_minus(estimate.T_imu_camera, T_imu_camera);
  const Vector6d sigma = extrinsic_covariance(estimate).diagonal().cwiseSqrt();
  return (change.cwiseAbs().array() <= kShare * sigma.array()).all() &&
         std::abs(estimate.time_offset_s - time_offset_s) <= kShare * std::sqrt(offset_variance(estimate));
}

/// Directions in which the posterior is at least half as wide as the prior.
void find_undetermined(const smoother::BatchEstimate& estimate, const CalibrationOptions& options,
                       std::vector<Undetermined>& found) {
  constexpr double kShare = 0.5;
  struct Part {
    const char* name;
    int place;
    double prior;
  };
  for (const Part& part : {Part{"rotation", smoother::kCommonRotation, options.rotation_prior_rad},
                           Part{"translation", smoother::kCommonTranslation, options.translation_prior_m}}) {
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
  const double sigma_s = std::sqrt(offset_variance(estimate));
  if (sigma_s >= kShare * options.time_offset_prior_s)
    found.push_back({"time_offset", Vector3d::Zero(), sigma_s});
}

void describe(const smoother::BatchEstimate& estimate, const CalibrationOptions& options,
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

}  // namespace

Result<CameraImuCalibration> calibrate(recording::Recording recording, const config::Config& config,
                                       const CalibrationOptions& options, const Workers& workers,
                                       const run::RunControl& control) {
  check(options.max_rounds >= 2, "the first round is no result");
  CameraImuCalibration result;
  result.T_imu_camera_before = recording.rig.T_imu_camera;
  if (recording.imu_source == recording::ImuSource::recorded && recording.calibration &&
      recording.calibration->imu)
    result.time_offset_before_s = recording.calibration->imu->time_offset_s;
  const std::vector<ImuSample> samples = recording.imu;
  double time_offset_s = 0;  // on top of the recording's, which the reader has taken out
  for (int round = 0; round < options.max_rounds && !result.converged; ++round) {
    const auto shift_ns = static_cast<std::int64_t>(std::llround(1e9 * time_offset_s));
    for (std::size_t i = 0; i < samples.size(); ++i)
      recording.imu[i].timestamp_ns = samples[i].timestamp_ns - shift_ns;
    config::Config exaggerated = config;
    exaggerated.motion.imu_noise_factor *= exaggeration(round);
    auto measured = measure_motion(recording, exaggerated, workers, control);
    if (!measured) return tl::unexpected(measured.error());
    smoother::BatchInput& input = measured->input;
    input.imu = samples;
    input.time_offset_s = time_offset_s;
    const SE3 T_imu_camera = recording.rig.T_imu_camera;
    const smoother::BatchOptions batch{.rotation_prior_rad = options.rotation_prior_rad,
                                       .translation_prior_m = options.translation_prior_m,
                                       .time_offset_prior_s = options.time_offset_prior_s,
                                       .T_imu_camera_expected = result.T_imu_camera_before,
                                       .time_offset_expected_s = 0};
    const auto estimate = smoother::estimate_batch(input, batch);
    if (!estimate) return tl::unexpected(estimate.error());
    // A first round that found nothing to change has been measured loosely; the second one is the result.
    result.converged = round > 0 && moved_little(*estimate, T_imu_camera, time_offset_s);
    result.frames = measured->stamps_ns.size();
    result.tracked = measured->tracked;
    describe(*estimate, options, result);
    result.rounds.push_back({exaggeration(round), result.T_imu_camera, result.time_offset_s});
    recording.rig.T_imu_camera = estimate->T_imu_camera;
    time_offset_s = estimate->time_offset_s;
  }
  return result;
}

calibration::RigCalibration calibrated_rig(const recording::Recording& recording,
                                           const CameraImuCalibration& calibration) {
  check(recording.calibration.has_value(), "the recording's reader kept its calibration");
  calibration::RigCalibration rig = *recording.calibration;
  const Vector6d sigma = calibration.extrinsic_covariance.diagonal().cwiseSqrt();
  rig.imu = calibration::ImuCalibration{calibration.T_imu_camera, recording.rig.imu_noise,
                                        calibration.time_offset_s};
  rig.source = fmt::format(
      "T_imu_color and time_offset_s by fusebench calibrate on {} frames of {} (standard deviations {:.3f} "
      "deg, {:.1f} mm, {:.2f} ms); the rest: {}",
      calibration.frames, recording.name, sigma.head<3>().maxCoeff() / radians(1.0),
      1e3 * sigma.tail<3>().maxCoeff(), 1e3 * calibration.time_offset_sigma_s,
      recording.calibration->source.empty() ? "no source given" : recording.calibration->source);
  return rig;
}

}  // namespace fusebench::batch_estimation
