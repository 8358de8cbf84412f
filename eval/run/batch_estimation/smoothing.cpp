#include "eval/run/batch_estimation/smoothing.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "core/base/trajectory/trajectory_file.hpp"
#include "core/config/config.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/run/batch_estimation/measured_motion.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::batch_estimation {

Result<SmoothedRecording> smooth(const recording::Recording& recording, const config::Config& config,
                                 const Workers& workers, const run::RunControl& control) {
  // As for a calibration: poses that are the images' own, so that nothing inertial is counted twice.
  constexpr double kExaggeration = 20;
  config::Config exaggerated = config;
  exaggerated.motion.imu_noise_factor *= kExaggeration;
  auto measured = measure_motion(recording, exaggerated, workers, control);
  if (!measured) return tl::unexpected(measured.error());
  smoother::BatchOptions options;
  options.time_offset_prior_s = config.initialisation.imu_time_offset_sigma_s;
  const SensorTiming& timing = recording.rig.timing;
  options.timing_prior_s = {timing.color_readout_sigma_s, timing.depth_readout_sigma_s,
                            timing.depth_delay_sigma_s};
  auto estimate = smoother::estimate_batch(measured->input, options);
  if (!estimate) return tl::unexpected(estimate.error());
  SmoothedRecording smoothed;
  smoothed.stamps_ns = measured->stamps_ns;
  smoothed.instants_ns = measured->input.instants_ns;
  smoothed.tracked = measured->tracked;
  for (std::size_t k = 0; k < smoothed.stamps_ns.size(); ++k) {
    const auto camera = [&](const filter::FilterState& state) {
      return StampedPose{smoothed.stamps_ns[k], state.T_world_imu * estimate->T_imu_camera};
    };
    smoothed.trajectory.push_back(camera(estimate->frames[k].state));
    smoothed.measuring_trajectory.push_back(camera(measured->input.initial[k]));
  }
  smoothed.estimate = std::move(*estimate);
  return smoothed;
}

std::vector<std::string> smoothing_remarks(const SmoothedRecording& smoothed) {
  std::vector<std::string> remarks;
  if (!smoothed.estimate.converged) {
    remarks.push_back(
        fmt::format("the batch estimate was still moving after {} rounds, which makes it no reference",
                    smoothed.estimate.rounds));
  }
  const std::size_t frames = smoothed.stamps_ns.size();
  if (smoothed.tracked < frames) {
    remarks.push_back(
        fmt::format("{} of {} frames were lost: there the trajectory follows the inertial samples alone",
                    frames - smoothed.tracked, frames));
  }
  return remarks;
}

std::string pseudo_truth_text(const SmoothedRecording& smoothed) {
  return fmt::format("# {}\n{}", recording::kPseudoGroundTruth, trajectory::tum_text(smoothed.trajectory));
}

std::string smoothed_states_text(const SmoothedRecording& smoothed) {
  std::string text =
      "capture_ns,px_m,py_m,pz_m,qw,qx,qy,qz,vx_mps,vy_mps,vz_mps,bgx_radps,bgy_radps,bgz_radps,bax_mps2,"
      "bay_mps2,baz_mps2,sigma_rx_rad,sigma_ry_rad,sigma_rz_rad,sigma_px_m,sigma_py_m,sigma_pz_m,"
      "sigma_vx_mps,sigma_vy_mps,sigma_vz_mps,sigma_bgx_radps,sigma_bgy_radps,sigma_bgz_radps,"
      "sigma_bax_mps2,sigma_bay_mps2,sigma_baz_mps2,visual_residual\n";
  for (std::size_t k = 0; k < smoothed.instants_ns.size(); ++k) {
    const smoother::BatchFrame& frame = smoothed.estimate.frames[k];
    const filter::FilterState& x = frame.state;
    const Quaterniond& q = x.T_world_imu.rotation;
    Eigen::Matrix<double, 16, 1> value;
    value << x.T_world_imu.translation, q.w(), q.x(), q.y(), q.z(), x.velocity_world_mps,
        x.gyroscope_bias_radps, x.accelerometer_bias_mps2;
    const Eigen::Matrix<double, smoother::kBatchStateSize, 1> sigma = frame.covariance.diagonal().cwiseSqrt();
    text +=
        fmt::format("{},{},{},{}\n", smoothed.instants_ns[k], fmt::join(value, ","), fmt::join(sigma, ","),
                    frame.visual_residual < 0 ? std::string() : fmt::format("{}", frame.visual_residual));
  }
  return text;
}

namespace {

nlohmann::ordered_json errors_of(const Trajectory& trajectory, const recording::Recording& recording) {
  nlohmann::ordered_json errors;
  if (const auto ate = trajectory_error::absolute_trajectory_error(recording.ground_truth, trajectory)) {
    errors["ate_rmse_m"] = ate->stats.rmse;
    errors["ate_max_m"] = ate->stats.max;
  }
  const auto rpe = trajectory_error::relative_pose_error(
      recording.ground_truth, trajectory, {.delta = 1, .unit = trajectory_error::DeltaUnit::seconds});
  if (rpe) {
    errors["rpe_1s_rmse_m"] = rpe->translation.rmse;
    errors["rpe_1s_rmse_rad"] = rpe->rotation.rmse;
  }
  return errors;
}

}  // namespace

std::string to_json(const SmoothedRecording& smoothed, const recording::Recording& recording) {
  const smoother::BatchEstimate& estimate = smoothed.estimate;
  const smoother::BatchFrame& last = estimate.frames.back();
  nlohmann::ordered_json document = {
      {"recording", recording.name},
      {"fingerprint", recording.fingerprint},
      {"label", recording::kPseudoGroundTruth},
      {"imu", recording::to_string(recording.imu_source)},
      {"frames", smoothed.stamps_ns.size()},
      {"tracked", smoothed.tracked},
      {"converged", estimate.converged},
      {"variance_factor", estimate.variance_factor},
      {"correlation_factor", estimate.correlation_factor},
      {"inertial_variance_factor", estimate.inertial_variance_factor},
      {"outliers", estimate.outliers},
      {"time_offset_s", estimate.time_offset_s},
      {"last_position_sigma_m",
       std::sqrt(last.covariance.block<3, 3>(filter::kPosition, filter::kPosition).trace())},
      {"last_rotation_sigma_rad",
       std::sqrt(last.covariance.block<3, 3>(filter::kRotation, filter::kRotation).trace())}};
  if (!recording.ground_truth.empty() && recording.truth_label.empty()) {
    document["against_ground_truth"] = {
        {"smoothed", errors_of(smoothed.trajectory, recording)},
        {"measuring_run", errors_of(smoothed.measuring_trajectory, recording)}};
  }
  return text::json_text(document) + "\n";
}

}  // namespace fusebench::batch_estimation
