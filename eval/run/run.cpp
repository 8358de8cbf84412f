#include "eval/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/all_systems.hpp"
#include "core/base/error.hpp"
#include "core/base/io/staged_folder.hpp"
#include "core/base/trajectory/noisy_pose.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "core/base/types.hpp"
#include "core/config/config.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/meshing/marching_cubes.hpp"
#include "core/estimator/places/loops/loop_closure.hpp"
#include "core/estimator/places/loops/loop_tables.hpp"
#include "core/system/system.hpp"
#include "eval/metrics/loop_error/loop_error.hpp"
#include "eval/metrics/loop_error/loop_metrics.hpp"
#include "eval/record/clock_note.hpp"
#include "eval/record/process_meter.hpp"
#include "eval/record/profile/trace_file.hpp"
#include "eval/record/record.hpp"
#include "eval/record/record_origin.hpp"
#include "eval/record/run_files/filter_tables.hpp"
#include "eval/record/run_files/patch_table.hpp"
#include "eval/record/truth_contradiction.hpp"
#include "eval/run/foreign_runs.hpp"
#include "eval/run/preparation/preparation.hpp"
#include "eval/run/preparation/prepared_recording.hpp"
#include "eval/run/preparation/sensor_check.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_evaluation.hpp"
#include "eval/run/run_folder.hpp"
#include "eval/run/run_frames.hpp"

namespace fusebench::run {

namespace {

using Clock = std::chrono::steady_clock;

/// Turns what a system has reconstructed into a mesh.
class SurfaceMesher {
 public:
  SurfaceMesher(const config::Config& config, const Workers& workers) : config_(config), workers_(workers) {}

  record::RecordedModel operator()(std::monostate /*none*/) { return {}; }
  record::RecordedModel operator()(const tsdf::TsdfVolume& model) {
    mesh = meshing::extract_mesh(model, config_.tsdf.min_mesh_weight, workers_);
    return {mesh.vertices.size(), mesh.triangles.size(), model.block_count()};
  }
  record::RecordedModel operator()(Mesh& made) {
    mesh = std::move(made);
    return {mesh.vertices.size(), mesh.triangles.size(), 0};
  }

  Mesh mesh;

 private:
  const config::Config& config_;
  const Workers& workers_;
};

/// Makes the mesh of the surface, which ends with it: metrics need the memory.
record::RecordedModel make_mesh(system::Surface surface, const config::Config& config, const Workers& workers,
                                RunProgress& progress) {
  // What else the system had (keyframes, images) is gone, and the mesh needs the room.
  record::return_freed_memory();
  SurfaceMesher mesher(config, workers);
  progress.profile.mesh.begin = Clock::now();
  const record::RecordedModel model = std::visit(mesher, surface);
  progress.profile.mesh.end = Clock::now();
  progress.output.mesh = std::move(mesher.mesh);
  return model;
}

record::RecordedTiming timing_of(const RunProgress& progress, const record::ProcessCost& cost) {
  record::RecordedTiming timing;
  timing.wall_s = cost.wall_s;
  timing.cpu_s = cost.cpu_s;
  timing.peak_rss_bytes = cost.peak_rss_bytes;
  const auto processed =
      static_cast<double>(progress.frames.tracked + progress.frames.lost + progress.frames.other_segments);
  const auto mean = [&](double sum_ms) { return processed > 0 ? sum_ms / processed : 0.0; };
  timing.fps = cost.wall_s > 0 ? processed / cost.wall_s : 0.0;
  timing.stages_ms.emplace_back("decode", mean(progress.decode_ms));
  for (std::size_t stage = 0; stage < health::kStageNames.size(); ++stage) {
    timing.stages_ms.emplace_back(health::kStageNames[stage], mean(progress.stage_ms[stage]));
  }
  timing.stages_ms.emplace_back("mesh_once", progress.profile.mesh.milliseconds());
  timing.histograms = profile::stage_histograms(progress.profile);
  return timing;
}

void log_sensors(const record::RunRecord& record, RunProgress& progress) {
  for (const filter::SensorConstant& constant : record.sensors)
    progress.log +=
        fmt::format("sensor {} = {:.6g} +- {:.2g}\n", constant.name, constant.value, constant.sigma);
}

void log_silent_failures(const record::RunRecord& record, RunProgress& progress) {
  if (record.metrics.silent_frames().value_or(0) == 0) return;
  const record::RecordedSilentFailures& silent = *record.metrics.silent.value;
  progress.log += fmt::format("{} of {} poses are wrong (undetected failures), from frame {} on\n",
                              silent.failures.silent, silent.failures.judged,
                              record.recording.first_frame + silent.first_frame.value_or(0));
}

/// Inertial samples that results would be invalid with are refused; of other contradictions there are
/// warnings. A measured depth camera that contradicts the calibration is used. A large bias of the gyroscope
/// and a large offset of the IMU's clock are removed from the samples. A recording that is too short for
/// these measurements is checked for a wrong unit or wrong axes of its IMU only.
Result<void> check_sensors(PreparedRun& run, const Workers& workers) {
  const bool is_measured = preparation::is_long_enough(run.recording);
  const bool has_own_imu = run.recording.imu_source == recording::ImuSource::recorded;
  if (!run.spec.prepare || (!is_measured && !has_own_imu)) return {};
  const preparation::SensorCheck checked =
      is_measured ? preparation::check_sensors(run.recording, run.spec.out, workers)
                  : preparation::inspected_sensors(run.recording, workers);
  if (auto refused = preparation::refusal(checked, run.recording.name)) {
    refused->hint += refused->hint.empty() ? "" : "; ";
    refused->hint += "--prepare off runs all the same";
    return tl::unexpected(*std::move(refused));
  }
  for (const inspection::Finding& finding : checked.findings)
    run.recording.warnings.push_back(finding.message);
  if (!is_measured) return {};
  if (checked.depth_camera) preparation::use_depth_camera(run.recording, *checked.depth_camera);
  if (checked.gyroscope_bias_radps) preparation::take_out_bias(run.recording, *checked.gyroscope_bias_radps);
  if (checked.imu_time_offset_s) preparation::take_out_time_offset(run.recording, *checked.imu_time_offset_s);
  return {};
}

/// The recording with the constants that it tells itself. What cannot be read is left to the run.
Result<void> measure_constants(PreparedRun& run, const Workers& workers, const RunControl& control) {
  if (!is_prepared(run.spec, run.recording)) return {};
  if (control.preparing && !preparation::is_kept(run.spec.out, run.recording)) control.preparing();
  auto recording = preparation::prepared_recording(run.recording, run.spec.out, workers, control.stop);
  if (recording) {
    run.recording = *std::move(recording);
    return {};
  }
  const Error& error = recording.error();
  if (error.code != ErrorCode::data_missing && error.code != ErrorCode::data_corrupt)
    return tl::unexpected(error);
  run.recording.notes.push_back("not prepared: " + error.message);
  return {};
}

struct LoopResults {
  std::string candidates;                                       ///< loops.csv
  std::string places;                                           ///< places.csv
  std::string log;                                              ///< a line: how many there were
  std::optional<record::Outcome<loop_error::LoopError>> error;  ///< if there is ground truth
};

std::string counts_line(const loops::LoopClosure& closure) {
  const auto accepted = std::ranges::count_if(closure.candidates(), &loops::LoopCandidate::accepted);
  return fmt::format("loops: {} places, {} candidates, {} accepted, poses corrected {} times on the way\n",
                     closure.places().size(), closure.candidates().size(), accepted,
                     closure.online_corrections());
}

/// What a run says of loops. truth: of the camera, at the stamps of the frames; empty if there is none.
/// closure: of a system after its last frame; nullptr of one that does not look for loops.
LoopResults loop_results(const loops::LoopClosure* closure, const Trajectory& truth,
                         const PinholeCamera& camera, const config::DepthConfig& depth,
                         const config::LoopsConfig& loops) {
  if (closure == nullptr) return {};
  LoopResults results{
      loops::candidate_table(*closure), loops::place_table(*closure), counts_line(*closure), {}};
  if (truth.empty()) return results;
  results.error = record::Outcome<loop_error::LoopError>::from(
      loop_error::loop_error(*closure, truth, camera, depth, loops));
  return results;
}

/// The revised poses of the system; nothing if it has none, or the run did not come to its end. What goes
/// wrong ends the run and is in the progress. Errors: run_failed (a stop).
Result<std::optional<Trajectory>> revised_poses(system::System& system, RunProgress& progress,
                                                const RunControl& control) {
  if (progress.status == record::RunStatus::failed || progress.frames.tracked == 0) return std::nullopt;
  auto revised = system.revise();
  if (!revised) {
    if (control.is_stopped()) return tl::unexpected(revised.error());
    progress.end(record::RunStatus::failed, "revising the poses: " + revised.error().message);
    return std::nullopt;
  }
  if (!*revised) return std::nullopt;
  progress.log +=
      fmt::format("poses revised at the end: {} frames, the model fused again\n", (*revised)->size());
  return revised;
}

/// The input of the metrics: the revised poses with the mesh of the online output.
RunOutput final_output(const Trajectory& revised, const RunOutput& online) {
  RunOutput output;
  output.has_filter = false;
  output.trajectory = revised;
  for (const filter::StampedEstimate& state : online.states)
    output.states.push_back({state.timestamp_ns, {}});
  output.mesh = online.mesh;
  return output;
}

}  // namespace

Result<record::RunRecord> execute_run(const PreparedRun& asked, const RunControl& control) {
  if (asked.spec.program) return execute_program_run(asked, control);
  const Workers workers(asked.spec.threads);
  PreparedRun prepared = asked;
  if (auto sound = check_sensors(prepared, workers); !sound) return tl::unexpected(sound.error());
  if (auto measured = measure_constants(prepared, workers, control); !measured)
    return tl::unexpected(measured.error());
  const PreparedRun& run = prepared;
  const record::ProcessMeter meter;
  auto folder = io::StagedFolder::create(run.folder);
  if (!folder) return tl::unexpected(folder.error());
  record::RunRecord record = requested_record(run);

  const config::Config& config = run.spec.config.values();
  SensorRig rig = run.recording.rig;
  if (run.spec.replicate > 0)
    rig.T_world_first_camera =
        trajectory::noisy_pose(static_cast<std::uint64_t>(run.spec.replicate), config.system.replicate_noise);
  FrameReplay replay(run, control);
  auto system = core::make_system(config, rig, run.recording.imu, workers,
                                  [&replay](const FrameVisitor& visitor) { return replay.visit(visitor); });
  auto progress = process_frames(run, *system, replay, *folder, control);
  if (!progress) return tl::unexpected(progress.error());
  auto revised = revised_poses(*system, *progress, control);
  if (!revised) return tl::unexpected(revised.error());
  const Trajectory truth = record::true_trajectory(run.recording, record::frame_stamps(run.recording));
  const LoopResults loops =
      loop_results(system->loops(), truth, run.recording.rig.camera, config.depth, config.loops);
  system::Surface surface = system->take_surface();
  system.reset();
  record.model = make_mesh(std::move(surface), config, workers, *progress);
  const record::ProcessCost cost = meter.cost();

  record.status = progress->status;
  record.reason = progress->reason;
  record.frames = progress->frames;
  record.sensors = estimated_sensors(progress->output, run.recording.rig.timing);
  log_sensors(record, *progress);
  record.metrics = metrics_of(progress->output, run.recording, config, workers);
  if (*revised) {
    const RunOutput output = final_output(**revised, progress->output);
    record.final_metrics = metrics_of(output, run.recording, config, workers);
    record.metrics.mesh = record.final_metrics->mesh;  // the model is of these poses
  }
  record::note_contradiction(record, truth, progress->output.trajectory);
  record.loops = loops.error;
  record.timing = timing_of(*progress, cost);
  const bool all = run.spec.kept == KeptFiles::all;
  const bool has_filter = progress->output.has_filter;
  if (all && has_filter) {
    if (auto written = run_files::write_patch_table(folder->path(), progress->fastest.frames()); !written)
      return tl::unexpected(written.error());
  }
  progress->log += loops.log;
  log_silent_failures(record, *progress);
  if (const auto note = record::clock_note(record)) progress->log += *note + "\n";
  if (const auto note = record::noted_contradiction(record)) progress->log += *note + "\n";
  progress->log += fmt::format("{}: {} of {} frames tracked\n", record::to_string(record.status),
                               record.frames.tracked, record.frames.total);
  if (const std::string segments = record::segments_text(record.frames); !segments.empty())
    progress->log += segments + "\n";
  const std::string title = fmt::format("fusebench {} {}", record.recording.name, record.variant);
  const std::array<NamedText, 10> texts = {
      {{"trajectory.tum", trajectory::tum_text(progress->output.trajectory)},
       {"truth.tum", record::evaluated_truth_text(run.recording)},
       {"final.tum", *revised ? trajectory::tum_text(**revised) : ""},
       {"loops.csv", loops.candidates},
       {"places.csv", loops.places},
       {"frames.csv", progress->frame_table},
       {"states.csv", all && has_filter ? progress->state_table : ""},
       {"nees.csv", has_filter ? run_files::nees_table(record.metrics.nees) : ""},
       {profile::kTraceFile, run.spec.profile ? profile::trace_text(progress->profile, title) : ""},
       {"log.txt", progress->log}}};
  const bool has_mesh = has_filter || !progress->output.mesh.vertices.empty();
  Mesh* const mesh = all && has_mesh ? &progress->output.mesh : nullptr;
  if (auto written = write_run_folder(*folder, mesh, texts, record); !written)
    return tl::unexpected(written.error());
  return record;
}

}  // namespace fusebench::run
