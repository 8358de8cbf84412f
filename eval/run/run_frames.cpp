#include "eval/run/run_frames.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <utility>

#include "core/config/config.hpp"
#include "eval/metrics/intensity_file.hpp"
#include "eval/record/record_origin.hpp"
#include "eval/run/frame_source.hpp"

namespace fusebench::run {

namespace {

using FrameClock = std::chrono::steady_clock;

metrics::FrameResiduals residuals_of(const health::FrameReport& report) {
  metrics::FrameResiduals residuals;
  if (report.pixels_photometric > 0) residuals.chi2_photometric = report.chi2_photometric;
  if (report.pixels_geometric > 0) residuals.chi2_geometric = report.chi2_geometric;
  residuals.patches_tracked = report.patches_tracked;
  residuals.patches_accepted = report.patches_accepted;
  return residuals;
}

/// The run begins at this frame: those before are lost, also one that it began at before.
void forget_earlier_start(RunProgress& progress, std::size_t frame, const health::FrameOutcome& outcome) {
  progress.log +=
      fmt::format("frame {}: {}\n", frame,
                  outcome.reason.empty() ? "started: no frame before could be used" : outcome.reason);
  progress.frames.lost += std::exchange(progress.frames.tracked, 0);
  progress.output.trajectory.clear();
  progress.output.states.clear();
  progress.output.last_state.reset();
}

/// What only a filter says of a frame.
void take_filter_report(RunProgress& progress, const health::FrameReport& report,
                        const SensorTiming& timing) {
  progress.state_table += run_files::state_table_row(report, timing);
  // The first frame has nothing to be compared with: it is no frame without tracked pixels.
  if (report.status == health::FrameStatus::initialised) return;
  progress.output.intensity.add_frame(report.pixels.intensity);
  progress.output.intensity_readings.add_frame(report.pixels.squares);
  if (health::is_in_map(report.status)) progress.output.residuals.add_frame(residuals_of(report));
}

/// A frame with a pose.
void take_pose(RunProgress& progress, std::size_t frame, const health::FrameOutcome& outcome,
               const health::FrameReport* filter) {
  if (outcome.status == health::FrameStatus::relocalised)
    progress.log +=
        fmt::format("frame {}: relocalised: found its place again by a frame seen before\n", frame);
  if (outcome.status == health::FrameStatus::initialised && frame > 0)
    forget_earlier_start(progress, frame, outcome);
  // A start that is not the first one is none until a frame is tracked from it.
  progress.lost_in_a_row = outcome.reason.empty() ? 0 : progress.lost_in_a_row + 1;
  ++progress.frames.tracked;
  progress.output.trajectory.push_back({outcome.timestamp_ns, outcome.T_world_camera});
  if (filter == nullptr) {
    progress.output.states.push_back({outcome.capture_ns, {}});
    return;
  }
  progress.output.states.push_back(filter::stamped_estimate(outcome.capture_ns, filter->estimate));
  progress.output.last_state = filter->estimate;
}

/// Counts segments that begin or are joined.
void follow_segments(RunProgress& progress, std::size_t frame, const health::FrameOutcome& outcome) {
  if (outcome.joined_segment > 0) {
    ++progress.frames.segments_joined;
    progress.log += fmt::format("frame {}: segment {} is joined to the map\n", frame, outcome.joined_segment);
  }
  if (outcome.segment <= progress.frames.segments) return;
  progress.frames.segments = outcome.segment;
  progress.log += fmt::format("frame {}: lost, tracked in segment {} from here\n", frame, outcome.segment);
}

/// Takes one frame into the progress; ends the run when too many frames are lost in a row.
void take_frame(RunProgress& progress, std::size_t frame, const health::FrameOutcome& outcome,
                const health::FrameReport* filter, const PreparedRun& run, double decode_ms) {
  progress.frame_table += run_files::frame_table_row(frame, outcome, filter, decode_ms);
  progress.decode_ms += decode_ms;
  for (std::size_t stage = 0; stage < health::kStageNames.size(); ++stage) {
    progress.stage_ms[stage] += outcome.stages.sums_ms()[stage];
  }
  if (filter != nullptr) take_filter_report(progress, *filter, run.recording.rig.timing);
  follow_segments(progress, frame, outcome);
  if (outcome.poses_corrected)
    progress.log +=
        fmt::format("frame {}: a loop corrected the poses: {} frames fused again\n", frame, frame + 1);
  if (health::is_in_map(outcome.status)) {
    take_pose(progress, frame, outcome, filter);
    return;
  }
  if (outcome.status == health::FrameStatus::other_segment) {
    ++progress.frames.other_segments;
    progress.lost_in_a_row = 0;
    return;
  }
  ++progress.frames.lost;
  ++progress.lost_in_a_row;
  progress.log += fmt::format("frame {}: lost: {}\n", frame, outcome.reason);
  const int limit = run.spec.config.values().iekf.max_lost_frames;
  if (progress.lost_in_a_row > static_cast<std::size_t>(limit)) {
    progress.end(record::RunStatus::lost,
                 fmt::format("lost at frame {}: {} (iekf.max_lost_frames = {})",
                             frame + 1 - progress.lost_in_a_row, outcome.reason, limit));
  }
}

/// A run that went to its end: a first frame alone is tracked in the dark, too.
void end_if_hardly_tracked(RunProgress& progress, const config::EvaluationConfig& config) {
  const record::RecordedFrames& frames = progress.frames;
  const double least = config.min_tracked_share * static_cast<double>(frames.total);
  if (progress.status != record::RunStatus::ok || static_cast<double>(frames.tracked) >= least) return;
  const std::string segments = record::segments_text(frames);
  progress.end(
      record::RunStatus::lost,
      fmt::format("only {} of {} frames tracked{}{} (evaluation.min_tracked_share = {})", frames.tracked,
                  frames.total, segments.empty() ? "" : ", ", segments, config.min_tracked_share));
}

bool is_bad_data(const Error& error) {
  return error.code == ErrorCode::data_missing || error.code == ErrorCode::data_corrupt;
}

/// The error of a frame ends the run and is in the progress, unless the caller wants it as an error.
Result<void> end_at_frame(RunProgress& progress, std::size_t frame, Error error, const RunControl& control) {
  error.message = fmt::format("frame {}: {}", frame, error.message);
  if (is_bad_data(error) && !control.bad_data_is_recorded) return tl::unexpected(std::move(error));
  progress.end(record::RunStatus::failed, std::move(error.message));
  return {};
}

/// intensity.bin, if it is kept.
Result<std::optional<metrics::IntensityWriter>> intensity_writer(const PreparedRun& run,
                                                                 const io::StagedFolder& folder) {
  if (run.spec.kept != KeptFiles::all ||
      run.spec.config.values().system.method != config::SystemMethod::filter)
    return std::nullopt;
  const PinholeCamera& camera = run.recording.rig.camera;
  auto writer =
      metrics::IntensityWriter::create(folder.file("intensity.bin"), camera.width_px, camera.height_px);
  if (!writer) return tl::unexpected(writer.error());
  return std::move(*writer);
}

}  // namespace

void RunProgress::end(record::RunStatus how, std::string why) {
  status = how;
  reason = std::move(why);
  log += fmt::format("{}: {}\n", record::to_string(status), reason);
}

Result<void> FrameReplay::visit(const FrameVisitor& visitor) const {
  FrameSource source(run_.recording, run_.spec.threads > 1);
  for (std::size_t frame = 0; frame < seen_; ++frame) {
    if (control_.is_stopped()) return fail(ErrorCode::run_failed, "stopped by the user");
    const auto loaded = source.next();
    if (!loaded) return tl::unexpected(loaded.error());
    if (auto visited = visitor(loaded->frame); !visited) return visited;
    if (control_.progress) control_.progress(frame + 1, run_.recording.frames.size());
  }
  return {};
}

Result<RunProgress> process_frames(const PreparedRun& run, system::System& system, FrameReplay& replay,
                                   const io::StagedFolder& folder, const RunControl& control) {
  RunProgress progress;
  const recording::Recording& recording = run.recording;
  progress.frames.total = recording.frames.size();
  for (const std::string& note : record::reading_notes(recording, run.spec.recording))
    progress.log += note + "\n";
  progress.output.has_filter = run.spec.config.values().system.method == config::SystemMethod::filter;
  auto intensity = intensity_writer(run, folder);
  if (!intensity) return tl::unexpected(intensity.error());
  progress.profile.decodes_ahead = run.spec.threads > 1;
  if (run.spec.profile) progress.profile.frames.reserve(recording.frames.size());
  FrameSource source(recording, progress.profile.decodes_ahead);
  const auto ends = [&](std::size_t frame, Error error) {
    return end_at_frame(progress, frame, std::move(error), control);
  };
  for (std::size_t frame = 0; frame < recording.frames.size() && progress.status == record::RunStatus::ok;
       ++frame) {
    if (control.is_stopped()) return fail(ErrorCode::run_failed, "stopped by the user");
    const auto begin = FrameClock::now();
    const auto loaded = source.next();
    const auto ready = FrameClock::now();
    if (!loaded) {
      if (const auto ended = ends(frame, loaded.error()); !ended) return tl::unexpected(ended.error());
      break;
    }
    replay.set_seen(frame + 1);
    const auto outcome = system.process(loaded->frame);
    if (!outcome) {
      if (control.is_stopped()) return tl::unexpected(outcome.error());
      if (const auto ended = ends(frame, outcome.error()); !ended) return tl::unexpected(ended.error());
      break;
    }
    const auto processed = FrameClock::now();
    const health::FrameReport* const report = system.filter_report();
    take_frame(progress, frame, *outcome, report, run, loaded->decode.milliseconds());
    if (*intensity && report != nullptr) {
      progress.fastest.offer(frame, *report, loaded->frame.grey);
      if (auto written = (*intensity)->write_frame(report->timestamp_ns, report->pixels.intensity); !written)
        return tl::unexpected(written.error());
    }
    if (run.spec.profile)
      progress.profile.frames.push_back({frame,
                                         outcome->status,
                                         loaded->decode,
                                         {begin, ready},
                                         outcome->stages,
                                         {processed, FrameClock::now()}});
    if (control.progress) control.progress(frame + 1, recording.frames.size());
  }
  if (progress.status == record::RunStatus::ok && progress.frames.tracked == 0)
    progress.end(record::RunStatus::lost, "no frame could be used as the first one (see log.txt)");
  end_if_hardly_tracked(progress, run.spec.config.values().evaluation);
  if (*intensity) {
    if (auto finished = (*intensity)->finish(); !finished) return tl::unexpected(finished.error());
  }
  return progress;
}

}  // namespace fusebench::run
