#include "eval/report/run_charts/run_series.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/metrics/reference_clock/clocked_errors.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/page/series_colours.hpp"
#include "eval/record/run_files/record_files.hpp"

namespace fusebench::run_charts {

namespace {

namespace fs = std::filesystem;

/// Nothing of a trajectory that is not there: a run without truth, or that lost its first frame.
Trajectory trajectory_of(const run_files::FoundRun& run, const char* name,
                         std::vector<std::string>& warnings) {
  const fs::path file = run.folder / name;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  if (auto checked = run_files::check_file(run.folder, run.record, name); !checked) {
    warnings.push_back(fmt::format("{}: {}", run.folder.string(), checked.error().message));
    return {};
  }
  auto read = trajectory::read_tum_trajectory(file, warnings);
  if (read) return std::move(*read);
  // That of a run that tracked nothing has a heading alone, as the run wrote it.
  if (run.record.frames.tracked > 0) warnings.push_back(read.error().message);
  return {};
}

/// The rows of a table that only some runs have.
template <class Row>
std::vector<Row> rows_of(const run_files::FoundRun& run, const char* name,
                         Result<std::vector<Row>> (*read)(const fs::path& file),
                         std::vector<std::string>& warnings) {
  std::error_code ignored;
  if (!fs::exists(run.folder / name, ignored)) return {};
  auto rows = read(run.folder / name);
  if (rows) return std::move(*rows);
  warnings.push_back(rows.error().message);
  return {};
}

/// The ground truth by the clock that the metrics are of.
Trajectory on_clock_of(const record::RecordedMetrics& metrics, Trajectory truth) {
  const auto& clock = metrics.reference_clock.value;
  if (!clock || !clock->applied) return truth;
  return reference_clock::on_estimate_clock(std::move(truth), clock->offset.offset_s);
}

/// ate: of this estimate; its alignment and its association are those of the poses.
std::vector<ComparedPose> compared(const Trajectory& estimate, const Trajectory& all_truth,
                                   const record::Outcome<trajectory_error::AteResult>& ate) {
  const Trajectory truth = ate.value ? all_truth : Trajectory{};
  const SE3 T_truth_world = ate.value ? ate.value->alignment.T_reference_estimate : SE3{};
  std::vector<ComparedPose> poses;
  for (const StampedPose& pose : estimate)
    poses.push_back({pose.timestamp_ns, T_truth_world * pose.T_world_camera, {}, 0});
  const auto pairs = trajectory_error::associated_poses(truth, estimate, {});
  if (!pairs) return poses;
  for (const auto& [true_pose, estimated] : *pairs) {
    ComparedPose& both = poses[estimated];
    both.T_truth_truth = truth[true_pose].T_world_camera;
    both.error_m = (both.T_truth_camera.translation - both.T_truth_truth->translation).norm();
  }
  return poses;
}

/// The ground truth is the last resort: it begins before the first image.
std::int64_t start_of(const record::RunRecord& record, const RunSeries& series, const Trajectory& estimate) {
  if (record.recording.start_ns) return *record.recording.start_ns;
  if (!series.frames.empty()) return series.frames.front().timestamp_ns;
  if (!estimate.empty()) return estimate.front().timestamp_ns;
  return series.truth.empty() ? 0 : series.truth.front().timestamp_ns;
}

}  // namespace

RunSeries series_of(const run_files::FoundRun& run, std::string label) {
  RunSeries series;
  series.run = &run;
  series.label = std::move(label);
  std::error_code ignored;
  const bool foreign = (run.record.config.empty() || run.record.program.has_value()) &&
                       !fs::exists(run.folder / "frames.csv", ignored);
  Result<std::vector<run_files::FrameTableRow>> frames =
      foreign ? std::vector<run_files::FrameTableRow>()
              : run_files::read_frame_table(run.folder / "frames.csv");
  if (frames) {
    series.frames = std::move(*frames);
  } else {
    series.warnings.push_back(frames.error().message);
  }
  // Without truth there is no file, or one with a heading alone in older runs.
  const Trajectory truth =
      run.record.recording.truth == "none" ? Trajectory{} : trajectory_of(run, "truth.tum", series.warnings);
  series.truth = on_clock_of(run.record.metrics, truth);
  const Trajectory estimate = trajectory_of(run, "trajectory.tum", series.warnings);
  if (!estimate.empty()) series.T_first_world = estimate.front().T_world_camera.inverse();
  series.start_ns = start_of(run.record, series, estimate);
  series.nees = rows_of(run, "nees.csv", run_files::read_nees_table, series.warnings);
  series.candidates = rows_of(run, "loops.csv", run_files::read_candidate_table, series.warnings);
  series.places = rows_of(run, "places.csv", run_files::read_place_table, series.warnings);
  series.poses = compared(estimate, series.truth, run.record.metrics.ate);
  if (run.record.final_metrics) {
    const Trajectory revised = trajectory_of(run, "final.tum", series.warnings);
    if (!revised.empty()) series.T_first_world = revised.front().T_world_camera.inverse();
    series.final_poses =
        compared(revised, on_clock_of(*run.record.final_metrics, truth), run.record.final_metrics->ate);
  }
  return series;
}

void colour_by_variant(std::span<RunSeries> series) {
  std::vector<page::ColouredName> names;
  for (const RunSeries& one : series) {
    const std::string& variant = one.run->record.variant;
    names.push_back({variant, run_files::variant_rank(variant)});
  }
  const std::vector<std::size_t> colours = page::series_colours(names);
  for (std::size_t i = 0; i < series.size(); ++i) series[i].colour = colours[i];
}

}  // namespace fusebench::run_charts
