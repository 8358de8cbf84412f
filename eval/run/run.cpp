#include "eval/run/run.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <chrono>
#include <utility>

#include "core/config/variants.hpp"
#include "core/io/fingerprint.hpp"
#include "core/io/staged_folder.hpp"
#include "core/mesh/ply_file.hpp"
#include "core/meshing/marching_cubes.hpp"
#include "core/pipeline.hpp"
#include "core/trajectory/trajectory_file.hpp"
#include "datasets/synthetic_imu/synthetic_imu.hpp"
#include "eval/metrics/intensity_file.hpp"
#include "eval/profile/run_profile.hpp"
#include "eval/profile/trace_file.hpp"
#include "eval/record/build_info.hpp"
#include "eval/record/process_meter.hpp"
#include "eval/record/record_origin.hpp"
#include "eval/run/frame_source.hpp"
#include "eval/run/run_evaluation.hpp"
#include "eval/run_files/frame_table.hpp"
#include "eval/run_files/nees_table.hpp"
#include "eval/run_files/patch_table.hpp"
#include "eval/run_files/record_files.hpp"
#include "eval/run_files/state_table.hpp"

namespace fusebench::run {

namespace {

using Clock = std::chrono::steady_clock;

/// What the frames left behind; grows frame by frame.
struct Progress {
  record::RunStatus status = record::RunStatus::ok;
  std::string reason;
  record::RecordedFrames frames;
  std::size_t lost_in_a_row = 0;
  RunOutput output;
  run_files::FastestFrames fastest;
  std::string frame_table = run_files::frame_table_header();
  std::string state_table = run_files::state_table_header();
  std::string log;
  double decode_ms = 0;
  std::array<double, health::kStageNames.size()> stage_ms{};
  profile::RunProfile profile;  ///< stays without frames unless it is asked for

  void end(record::RunStatus how, std::string why) {
    status = how;
    reason = std::move(why);
    log += fmt::format("{}: {}\n", record::to_string(status), reason);
  }
};

Result<void> provide_imu(recording::Recording& recording, const RunSpec& spec) {
  if (!config::needs_imu(spec.config.values)) {
    recording.imu.clear();
    recording.imu_source = recording::ImuSource::none;
    recording.imu_note.clear();
    return {};
  }
  const bool recorded = recording.imu_source != recording::ImuSource::none;
  if (spec.imu == ImuChoice::synthetic || (spec.imu == ImuChoice::automatic && !recorded))
    return synthetic_imu::add_synthetic_imu(recording);
  if (recorded) return {};
  return fail(
      ErrorCode::usage,
      fmt::format("variant '{}' needs an IMU, and recording '{}' has none", spec.variant, recording.name),
      "--imu synthetic (or auto, where there is none) makes one from the ground truth and says so in every "
      "table; --variant no-imu does without");
}

metrics::FrameResiduals residuals_of(const health::FrameReport& report) {
  metrics::FrameResiduals residuals;
  if (report.pixels_photometric > 0) residuals.chi2_photometric = report.chi2_photometric;
  if (report.pixels_geometric > 0) residuals.chi2_geometric = report.chi2_geometric;
  residuals.patches_tracked = report.patches_tracked;
  residuals.patches_accepted = report.patches_accepted;
  return residuals;
}

/// The run begins at this frame: those before are lost, also one that it began at before.
void forget_earlier_start(Progress& progress, std::size_t frame, const health::FrameReport& report) {
  progress.log +=
      fmt::format("frame {}: {}\n", frame,
                  report.reason.empty() ? "started: no frame before could be used" : report.reason);
  progress.frames.lost += std::exchange(progress.frames.tracked, 0);
  progress.output.trajectory.clear();
  progress.output.states.clear();
}

/// Takes one frame's report into the progress; ends the run when too many frames are lost in a row.
void take_report(Progress& progress, std::size_t frame, const health::FrameReport& report,
                 const PreparedRun& run, double decode_ms) {
  progress.frame_table += run_files::frame_table_row(frame, report, decode_ms);
  progress.state_table += run_files::state_table_row(report);
  progress.decode_ms += decode_ms;
  for (std::size_t stage = 0; stage < health::kStageNames.size(); ++stage) {
    progress.stage_ms[stage] += report.stages.sums_ms()[stage];
  }
  // The first frame has nothing to be compared with: it is no frame without tracked pixels.
  if (report.status != health::FrameStatus::initialised)
    progress.output.intensity.add_frame(report.pixels.intensity);
  if (report.status != health::FrameStatus::lost) {
    if (report.status == health::FrameStatus::relocalised)
      progress.log +=
          fmt::format("frame {}: relocalised: found its place again by a frame seen before\n", frame);
    if (report.status == health::FrameStatus::initialised && frame > 0)
      forget_earlier_start(progress, frame, report);
    // A start that is not the first one is none until a frame is tracked from it.
    progress.lost_in_a_row = report.reason.empty() ? 0 : progress.lost_in_a_row + 1;
    ++progress.frames.tracked;
    progress.output.trajectory.push_back({report.timestamp_ns, report.T_world_camera});
    progress.output.states.push_back({report.capture_ns, report.estimate});
    if (report.status != health::FrameStatus::initialised)
      progress.output.residuals.add_frame(residuals_of(report));
    return;
  }
  ++progress.frames.lost;
  ++progress.lost_in_a_row;
  progress.log += fmt::format("frame {}: lost: {}\n", frame, report.reason);
  const int limit = run.spec.config.values.iekf.max_lost_frames;
  if (progress.lost_in_a_row > static_cast<std::size_t>(limit)) {
    progress.end(record::RunStatus::lost,
                 fmt::format("lost at frame {}: {} (iekf.max_lost_frames = {})",
                             frame + 1 - progress.lost_in_a_row, report.reason, limit));
  }
}

bool is_bad_data(const Error& error) {
  return error.code == ErrorCode::data_missing || error.code == ErrorCode::data_corrupt;
}

/// The error of a frame ends the run and is in the progress, unless the caller wants it as an error.
Result<void> end_at_frame(Progress& progress, std::size_t frame, Error error, const RunControl& control) {
  error.message = fmt::format("frame {}: {}", frame, error.message);
  if (is_bad_data(error) && !control.bad_data_is_recorded) return tl::unexpected(std::move(error));
  progress.end(record::RunStatus::failed, std::move(error.message));
  return {};
}

/// All frames through the pipeline. Errors: io, a stop, and bad data if it is not recorded; whatever else
/// goes wrong ends the run and is in the progress.
Result<Progress> process_frames(const PreparedRun& run, core::Pipeline& pipeline,
                                const io::StagedFolder& folder, const RunControl& control) {
  Progress progress;
  const recording::Recording& recording = run.recording;
  progress.frames.total = recording.frames.size();
  for (const std::string& note : record::reading_notes(recording, run.spec.recording))
    progress.log += note + "\n";

  const PinholeCamera& camera = recording.rig.camera;
  std::optional<metrics::IntensityWriter> intensity;
  if (run.spec.kept == KeptFiles::all) {
    auto writer =
        metrics::IntensityWriter::create(folder.file("intensity.bin"), camera.width_px, camera.height_px);
    if (!writer) return tl::unexpected(writer.error());
    intensity.emplace(std::move(*writer));
  }
  progress.profile.decodes_ahead = run.spec.threads > 1;
  if (run.spec.profile) progress.profile.frames.reserve(recording.frames.size());
  FrameSource source(recording, progress.profile.decodes_ahead);
  for (std::size_t frame = 0; frame < recording.frames.size() && progress.status == record::RunStatus::ok;
       ++frame) {
    if (control.stop != nullptr && control.stop->load())
      return fail(ErrorCode::run_failed, "stopped by the user");
    const auto begin = Clock::now();
    const auto loaded = source.next();
    const auto ready = Clock::now();
    if (!loaded) {
      const auto ended = end_at_frame(progress, frame, loaded.error(), control);
      if (!ended) return tl::unexpected(ended.error());
      break;
    }
    const auto report = pipeline.process(loaded->frame);
    if (!report) {
      const auto ended = end_at_frame(progress, frame, report.error(), control);
      if (!ended) return tl::unexpected(ended.error());
      break;
    }
    const auto processed = Clock::now();
    take_report(progress, frame, *report, run, loaded->decode.milliseconds());
    if (intensity) {
      progress.fastest.offer(frame, *report, loaded->frame.grey);
      if (auto written = intensity->write_frame(report->timestamp_ns, report->pixels.intensity); !written)
        return tl::unexpected(written.error());
    }
    if (run.spec.profile) {
      progress.profile.frames.push_back(
          {frame, report->status, loaded->decode, {begin, ready}, report->stages, {processed, Clock::now()}});
    }
    if (control.progress) control.progress(frame + 1, recording.frames.size());
  }
  if (progress.status == record::RunStatus::ok && progress.frames.tracked == 0)
    progress.end(record::RunStatus::lost, "no frame could be used as the first one (see log.txt)");
  if (intensity) {
    if (auto finished = intensity->finish(); !finished) return tl::unexpected(finished.error());
  }
  return progress;
}

/// Makes the mesh of the model, which ends with it: metrics need the memory.
record::RecordedModel make_mesh(tsdf::TsdfVolume model, const config::Config& config, const Workers& workers,
                        Progress& progress) {
  // What else the pipeline had (keyframes, images) is gone, and the mesh needs the room.
  record::return_freed_memory();
  Mesh& mesh = progress.output.mesh;
  progress.profile.mesh.begin = Clock::now();
  mesh = meshing::extract_mesh(model, config.tsdf.min_mesh_weight, workers);
  progress.profile.mesh.end = Clock::now();
  return {mesh.vertices.size(), mesh.triangles.size(), model.block_count()};
}

record::RecordedTiming timing_of(const Progress& progress, const record::ProcessCost& cost) {
  record::RecordedTiming timing;
  timing.wall_s = cost.wall_s;
  timing.cpu_s = cost.cpu_s;
  timing.peak_rss_bytes = cost.peak_rss_bytes;
  const auto processed = static_cast<double>(progress.frames.tracked + progress.frames.lost);
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

/// The model, with the error of each vertex where there is a true scene, and the patches that moved fastest.
Result<void> write_surfaces(Progress& progress, const record::RecordedMetrics& metrics,
                            const io::StagedFolder& folder) {
  Mesh& mesh = progress.output.mesh;
  if (metrics.mesh.value) {
    const std::vector<double>& errors_m = metrics.mesh.value->vertex_errors_m;
    mesh.quality.assign(errors_m.begin(), errors_m.end());
  }
  if (auto written = mesh::write_ply(mesh, folder.file("mesh.ply")); !written) return written;
  return run_files::write_patch_table(folder.path(), progress.fastest.frames());
}

}  // namespace

std::string_view to_string(KeptFiles kept) { return kept == KeptFiles::all ? "all" : "small"; }

Result<FrameWindow> parse_window(const std::string& text) {
  FrameWindow window;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, window.begin);
  const bool colon = first.ec == std::errc{} && first.ptr != end && *first.ptr == ':';
  const auto second = colon ? std::from_chars(first.ptr + 1, end, window.end) : first;
  if (!colon || second.ec != std::errc{} || second.ptr != end || window.begin >= window.end) {
    return fail(ErrorCode::usage, fmt::format("frames {} (allowed: A:B with 0 <= A < B)", text),
                "A:B takes frames A to B-1");
  }
  return window;
}

std::string run_identity(const config::Config& config, const recording::Recording& recording) {
  const PinholeCamera& camera = recording.rig.camera;
  io::Fingerprint identity;
  identity.add(config::config_hash(config));
  identity.add(recording.fingerprint);
  identity.add(recording::to_string(recording.imu_source));
  identity.add(recording.imu_note);
  identity.add(fmt::format("{} {} {} {} {} {}", camera.width_px, camera.height_px, camera.fx_px, camera.fy_px,
                           camera.cx_px, camera.cy_px));
  identity.add(record::build_info().estimator);
  return identity.hex();
}

Result<recording::Recording> open_for_run(const RunSpec& spec) {
  auto recording = datasets::open_recording(spec.recording, spec.open);
  if (!recording) return recording;
  if (spec.frames) {
    if (auto cut = recording::select_frames(*recording, spec.frames->begin, spec.frames->end); !cut) {
      return tl::unexpected(cut.error());
    }
  }
  if (recording->frames.empty()) {
    return fail(ErrorCode::data_corrupt, fmt::format("recording '{}' has no frames", recording->name));
  }
  if (auto provided = provide_imu(*recording, spec); !provided) return tl::unexpected(provided.error());
  return recording;
}

std::optional<RecordHead> record_head(const std::filesystem::path& folder) {
  const auto run = run_files::found_run(folder);
  if (!run) return std::nullopt;
  return RecordHead{run->record.status, run->record.reason, run->record.run_id, run->state,
                    run_files::missing_files(folder, run->record)};
}

PreparedRun place_run(RunSpec spec, recording::Recording recording, const TakenFolders& taken) {
  PreparedRun run{std::move(spec), std::move(recording), {}, {}};
  run.run_id = run_identity(run.spec.config.values, run.recording);
  const std::string again = run.spec.repetition > 1 ? fmt::format("-r{}", run.spec.repetition) : "";
  const auto parent = run.spec.out / run.recording.name / run.spec.variant;
  for (const std::size_t digits : {std::size_t{8}, std::size_t{16}, run.run_id.size()}) {
    run.folder = parent / (run.run_id.substr(0, digits) + again);
    const auto there = record_head(run.folder);
    const auto planned = taken.find(run.folder);
    const bool of_another = there && !there->run_id.empty() && there->run_id != run.run_id;
    if (!of_another && (planned == taken.end() || planned->second == run.run_id)) break;
  }
  return run;
}

Result<PreparedRun> prepare_run(RunSpec spec) {
  if (auto related = config::check_relations(spec.config.values); !related)
    return tl::unexpected(related.error());
  auto recording = open_for_run(spec);
  if (!recording) return tl::unexpected(recording.error());
  return place_run(std::move(spec), std::move(*recording));
}

record::RunRecord record_of_question(const PreparedRun& run) {
  record::RunRecord record;
  record.recording = record::recorded_recording(run.recording, run.spec.recording,
                                                run.spec.frames ? run.spec.frames->begin : 0);
  record.variant = run.spec.variant;
  for (const config::OptionRow& row : config::describe_options(run.spec.config.values)) {
    record.config.push_back(
        {row.key, config::parse_option_value(row.value), run.spec.config.origin(row.key)});
  }
  record.config_hash = config::config_hash(run.spec.config.values);
  record.run_id = run.run_id;
  record.repetition = run.spec.repetition;
  record.provenance = record::provenance_here(run.spec.threads);
  return record;
}

Result<record::RunRecord> execute_run(const PreparedRun& run, const RunControl& control) {
  const record::ProcessMeter meter;
  auto folder = io::StagedFolder::create(run.folder);
  if (!folder) return tl::unexpected(folder.error());
  record::RunRecord record = record_of_question(run);

  const config::Config& config = run.spec.config.values;
  const Workers workers(run.spec.threads);
  core::Pipeline pipeline(config, run.recording.rig, run.recording.imu, workers);
  auto progress = process_frames(run, pipeline, *folder, control);
  if (!progress) return tl::unexpected(progress.error());
  record.model = make_mesh(std::move(pipeline).take_model(), config, workers, *progress);
  const record::ProcessCost cost = meter.cost();

  record.status = progress->status;
  record.reason = progress->reason;
  record.frames = progress->frames;
  record.metrics = metrics_of(progress->output, run.recording, config, workers);
  record.timing = timing_of(*progress, cost);
  const bool all = run.spec.kept == KeptFiles::all;
  if (all) {
    if (auto written = write_surfaces(*progress, record.metrics, *folder); !written)
      return tl::unexpected(written.error());
  }
  progress->log += fmt::format("{}: {} of {} frames tracked\n", record::to_string(record.status),
                               record.frames.tracked, record.frames.total);
  const std::string title = fmt::format("fusebench {} {}", record.recording.name, record.variant);
  const std::array<std::pair<std::string_view, std::string>, 7> texts = {
      {{"trajectory.tum", trajectory::tum_text(progress->output.trajectory)},
       {"truth.tum",
        trajectory::tum_text(record::true_trajectory(run.recording, record::frame_stamps(run.recording)))},
       {"frames.csv", progress->frame_table},
       {"states.csv", all ? progress->state_table : ""},
       {"nees.csv", run_files::nees_table(record.metrics.nees)},
       {profile::kTraceFile, run.spec.profile ? profile::trace_text(progress->profile, title) : ""},
       {"log.txt", progress->log}}};
  for (const auto& [name, text] : texts) {
    if (text.empty()) continue;  // no truth, not kept or not asked for
    if (auto written = folder->write(name, text); !written) return tl::unexpected(written.error());
  }
  if (auto done = run_files::commit_run(*folder, record); !done) return tl::unexpected(done.error());
  return record;
}

}  // namespace fusebench::run
