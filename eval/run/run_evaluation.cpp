#include "eval/run/run_evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/mesh/ply_file.hpp"
#include "core/base/trajectory/trajectory.hpp"
#include "core/config/config.hpp"
#include "core/config/variants.hpp"
#include "eval/metrics/reference_clock/clocked_errors.hpp"
#include "eval/metrics/trajectory_error/fitted_offset.hpp"
#include "eval/metrics/trajectory_error/pose_alignment.hpp"
#include "eval/metrics/trajectory_error/silent_failures.hpp"
#include "eval/record/pose_intensity/pose_intensity.hpp"
#include "eval/record/record_origin.hpp"
#include "eval/run/recording_views.hpp"

namespace fusebench::run {

namespace {

/// Errors of the trajectory against a ground truth: the recording's own, or that on another clock.
void add_trajectory_metrics(record::RecordedMetrics& metrics, const RunOutput& output,
                            const recording::Recording& recording, const Trajectory& ground_truth) {
  std::vector<std::int64_t> expected;
  for (const recording::FrameEntry& frame : recording.frames) expected.push_back(frame.timestamp_ns);
  trajectory_error::AteOptions ate;
  ate.expected_ns = expected;
  metrics.ate = record::Outcome<trajectory_error::AteResult>::from(
      trajectory_error::absolute_trajectory_error(ground_truth, output.trajectory, ate));
  metrics.ate_fitted = record::Outcome<trajectory_error::FittedOffset>::from(
      trajectory_error::fitted_offset(ground_truth, output.trajectory, ate));
  metrics.rpe_frame =
      record::Outcome<trajectory_error::RpeResult>::from(trajectory_error::relative_pose_error(
          ground_truth, output.trajectory, {.delta = 1, .unit = trajectory_error::DeltaUnit::frames}));
  metrics.rpe_second =
      record::Outcome<trajectory_error::RpeResult>::from(trajectory_error::relative_pose_error(
          ground_truth, output.trajectory, {.delta = 1, .unit = trajectory_error::DeltaUnit::seconds}));
}

Result<record::RecordedSilentFailures> silent_failures_of(const RunOutput& output,
                                                          const recording::Recording& recording,
                                                          const Trajectory& ground_truth,
                                                          const config::EvaluationConfig& config) {
  // At the instants that the poses are of, which are not always those of the stamps.
  const Trajectory truth =
      trajectory::of_point(record::true_trajectory(ground_truth, record::frame_stamps(recording)),
                           recording::ground_truth_offset_m(recording));
  const auto failures = trajectory_error::silent_failures(
      truth, output.trajectory,
      {config.silent_interval_s, config.silent_translation_m, radians(config.silent_rotation_deg)});
  if (!failures) return tl::unexpected(failures.error());
  record::RecordedSilentFailures silent{*failures, std::nullopt};
  if (failures->first_ns) {
    const auto first =
        std::ranges::find(recording.frames, *failures->first_ns,
                          [](const recording::FrameEntry& frame) { return frame.timestamp_ns; });
    if (first != recording.frames.end())
      silent.first_frame = static_cast<std::size_t>(first - recording.frames.begin());
  }
  return silent;
}

/// The metrics that compare the trajectory with a ground truth.
record::RecordedMetrics compared_with(const Trajectory& ground_truth, const RunOutput& output,
                                      const recording::Recording& recording,
                                      const config::EvaluationConfig& config) {
  record::RecordedMetrics metrics;
  add_trajectory_metrics(metrics, output, recording, ground_truth);
  metrics.silent = record::Outcome<record::RecordedSilentFailures>::from(
      silent_failures_of(output, recording, ground_truth, config));
  return metrics;
}

/// The trajectory at the instants that its poses are of.
Trajectory at_instants(const RunOutput& output) {
  Trajectory trajectory = output.trajectory;
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    trajectory[i].timestamp_ns = output.states[i].timestamp_ns;
  return trajectory;
}

reference_clock::ClockedErrors clocked_errors(const record::RecordedMetrics& metrics) {
  reference_clock::ClockedErrors errors;
  if (metrics.ate.value) errors.ate_rmse_m = metrics.ate.value->stats.rmse;
  if (const auto& rpe = metrics.rpe_second.value) {
    errors.rpe_1s_m = rpe->translation.rmse;
    errors.rpe_1s_rad = rpe->rotation.rmse;
  }
  errors.silent = metrics.silent_frames();
  return errors;
}

/// Metrics of the trajectory, with the ground truth as it is read or on the fitted clock as the options say.
record::RecordedMetrics trajectory_metrics(const RunOutput& output, const recording::Recording& recording,
                                           const config::EvaluationConfig& config) {
  if (recording.ground_truth.empty()) {
    record::RecordedMetrics none;
    none.ate.reason = none.ate_fitted.reason = none.rpe_frame.reason = none.rpe_second.reason =
        none.silent.reason = none.reference_clock.reason = "the recording has no ground truth";
    return none;
  }
  record::RecordedMetrics as_read = compared_with(recording.ground_truth, output, recording, config);
  const auto offset = reference_clock::fitted_time_offset(recording.ground_truth, at_instants(output));
  if (!offset) {
    as_read.reference_clock.reason = offset.error().message;
    return as_read;
  }
  record::RecordedMetrics fitted =
      compared_with(reference_clock::on_estimate_clock(recording.ground_truth, offset->offset_s), output,
                    recording, config);
  const bool applied = config.reference_time_offset == config::ReferenceTimeOffset::fitted;
  const reference_clock::ReferenceClock clock{*offset, applied, clocked_errors(as_read),
                                              clocked_errors(fitted)};
  record::RecordedMetrics metrics = applied ? std::move(fitted) : std::move(as_read);
  metrics.reference_clock = {clock, {}};
  return metrics;
}

record::RecordedNees nees_of(const RunOutput& output, const recording::Recording& recording,
                             const config::Config& config) {
  const auto none = [](const std::string& reason) {
    record::RecordedNees nees;
    nees.fill({std::nullopt, reason});
    return nees;
  };
  if (!output.has_filter) return none("the system has no covariance");
  if (recording.state_truth.empty()) return none("the recording has no true states");
  if (recording.imu_source == recording::ImuSource::synthetic) {
    return none("the true states are of the recorded IMU, and the run used a synthetic one");
  }
  // Without an inertial prior the body is the camera itself.
  const SE3& T_imu_camera = recording.rig.T_imu_camera;
  auto parts = config::needs_imu(config)
                   ? metrics::consistency(recording.state_truth, output.states, T_imu_camera)
                   : metrics::consistency(metrics::states_of_camera(recording.state_truth, T_imu_camera),
                                          output.states, SE3{});
  if (!parts) return none(parts.error().message);
  record::RecordedNees nees;
  for (std::size_t i = 0; i < nees.size(); ++i) {
    metrics::NeesResult& part = (*parts)[i];
    if (part.stats.count == 0) {
      nees[i] = {std::nullopt, fmt::format("the covariance of the {} is singular in all frames: the variant "
                                           "does not estimate it",
                                           part.part.name)};
    } else {
      nees[i] = {std::move(part), {}};
    }
  }
  return nees;
}

constexpr std::size_t kReconstructionSamples = 50'000;
constexpr std::size_t kTruthSamples = 200'000;  // of the whole scene, of which a run may see a corner

/// The tracked cameras of which the true ones at the same instants are known.
struct KnownCameras {
  std::vector<SE3> reference;
  std::vector<SE3> estimate;
};

KnownCameras known_cameras(const RunOutput& output, const recording::Recording& recording) {
  KnownCameras cameras;
  for (std::size_t i = 0; i < output.trajectory.size(); ++i) {
    const auto pose = record::true_camera(recording, output.states[i].timestamp_ns);
    if (!pose) continue;
    cameras.reference.push_back(*pose);
    cameras.estimate.push_back(output.trajectory[i].T_world_camera);
  }
  return cameras;
}

Result<record::RecordedMesh> mesh_error_of(const RunOutput& output, const recording::Recording& recording,
                                           const record::Outcome<trajectory_error::AteResult>& ate,
                                           const config::DepthConfig& depth, const Workers& workers) {
  if (output.mesh.vertices.empty()) return fail(ErrorCode::data_missing, "there is no reconstruction");
  if (recording.truth_mesh_file.empty()) {
    return fail(ErrorCode::data_missing, "the recording has no true mesh");
  }
  const KnownCameras cameras = known_cameras(output, recording);
  if (cameras.reference.empty()) {
    return fail(ErrorCode::data_missing, "no tracked frame has ground truth to align the mesh by");
  }
  const auto truth = mesh::read_ply(recording.truth_mesh_file);
  if (!truth) {
    // The place of the recording on this disk is not part of its record.
    return fail(truth.error().code,
                fmt::format("{} is not a usable mesh", recording.truth_mesh_file.filename().string()));
  }
  const auto views = recorded_views(recording, {depth.min_m, depth.max_m});
  if (!views) return tl::unexpected(views.error());
  mesh_error::MeshErrorOptions options;
  options.reconstruction.count = kReconstructionSamples;
  options.truth.count = kTruthSamples;
  const auto comparison =
      mesh_error::MeshComparison::create(output.mesh.cast<double>(), *truth, *views, options, workers);
  if (!comparison) return tl::unexpected(comparison.error());
  const auto aligned = trajectory_error::align_poses(cameras.reference, cameras.estimate);
  if (!aligned) return tl::unexpected(aligned.error());
  record::RecordedMesh mesh;
  mesh.reconstruction_sampling = options.reconstruction;
  mesh.truth_sampling = options.truth;
  mesh.reconstruction_samples = comparison->reconstruction_samples();
  mesh.truth_samples = comparison->truth_samples();
  mesh.truth_observed = comparison->truth_observed();
  mesh.views = views->T_truth_camera.size();
  mesh.min_depth_m = depth.min_m;
  mesh.max_depth_m = depth.max_m;
  mesh.poses = comparison->evaluate({"poses", *aligned}, workers);
  // Of the model's own vertices, which are the middles of discs.
  mesh.vertex_errors_m =
      mesh_error::distances_m(output.mesh.cast_vertices<double>(), *aligned, comparison->truth(), workers);
  // Of the first known one: ICL-NUIM's truth begins with its second image.
  const SE3 by_first_camera = cameras.reference.front() * cameras.estimate.front().inverse();
  mesh.first_camera = comparison->evaluate({"first_camera", by_first_camera}, workers);
  if (ate.value) mesh.positions = comparison->evaluate(ate.value->alignment, workers);
  return mesh;
}

Result<record::RecordedPoseIntensity> pose_intensity_of(const RunOutput& output,
                                                        const recording::Recording& recording,
                                                        const config::Config& config) {
  if (!config.evaluation.pose_intensity)
    return fail(ErrorCode::data_missing, "not asked for (evaluation.pose_intensity)");
  const pose_intensity::NamedTrajectory poses{"run", output.trajectory};
  // Probes by defaults, so that they are the same for every system and variant.
  const auto result = pose_intensity::pose_intensity(recording, {&poses, 1}, {});
  if (!result) return tl::unexpected(result.error());
  const pose_intensity::TrajectoryIntensity& run = result->trajectories.front();
  return record::RecordedPoseIntensity{run.aie_grey, run.rms_grey, result->frames, result->pixels,
                                       result->visibility_by_truth};
}

}  // namespace

record::RecordedMetrics metrics_of(const RunOutput& output, const recording::Recording& recording,
                                   const config::Config& config, const Workers& workers) {
  record::RecordedMetrics metrics = trajectory_metrics(output, recording, config.evaluation);
  metrics.aie = {output.intensity.result(), {}};
  const std::string no_patches = "the system has no patches";
  if (metrics.aie.value->all.frames == 0)
    metrics.aie = {std::nullopt, output.has_filter ? "no frame has tracked pixels" : no_patches};
  metrics.intensity_readings = {output.intensity_readings.result(), {}};
  if (output.intensity_readings.empty())
    metrics.intensity_readings = {
        std::nullopt, output.has_filter ? "not asked for (evaluation.intensity_readings)" : no_patches};
  metrics.residuals = {output.residuals.result(), {}};
  if (metrics.residuals.value->frames == 0)
    metrics.residuals = {std::nullopt, output.has_filter ? "no frame was tracked" : no_patches};
  metrics.pose_intensity =
      record::Outcome<record::RecordedPoseIntensity>::from(pose_intensity_of(output, recording, config));
  metrics.nees = nees_of(output, recording, config);
  metrics.mesh = record::Outcome<record::RecordedMesh>::from(
      mesh_error_of(output, recording, metrics.ate, config.depth, workers));
  return metrics;
}

std::vector<filter::SensorConstant> estimated_sensors(const RunOutput& output, const SensorTiming& timing) {
  if (!output.last_state) return {};
  std::vector<filter::SensorConstant> constants = filter::sensor_constants(*output.last_state, timing);
  std::erase_if(constants, [](const filter::SensorConstant& constant) { return constant.sigma == 0; });
  return constants;
}

}  // namespace fusebench::run
