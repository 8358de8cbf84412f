#include "eval/record/registry/run_metric.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/nearest_name.hpp"
#include "eval/record/registry/recorded_values.hpp"
#include "eval/record/registry/run_numbers.hpp"

namespace fusebench::registry {

namespace {

using enum Column;
using enum MetricKind;
using Statistics = metrics::Statistics;
using Ate = trajectory_error::AteResult;
using Rpe = trajectory_error::RpeResult;
using Silent = record::RecordedSilentFailures;
using Failures = trajectory_error::SilentFailures;
using Mesh = record::RecordedMesh;
using MeshErrors = mesh_error::MeshErrorResult;
using Distances = mesh_error::MeshDistances;
using Clock = reference_clock::ReferenceClock;

constexpr auto kLarger = Better::larger;
constexpr auto kNeither = Better::neither;
constexpr std::nullopt_t kNoGate = std::nullopt;
constexpr double kExact = 0;

std::optional<double> ratio(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b && *b > 0 ? std::optional(*a / *b) : std::nullopt;
}

/// Of the frames that were processed: a run that was lost early must not look fast.
std::optional<double> cpu_ms_per_frame(const RunNumbers& numbers) {
  const double processed = numbers["frames_tracked"].value_or(0) + numbers["frames_lost"].value_or(0) +
                           numbers["frames_other_segments"].value_or(0);
  const auto seconds = ratio(numbers["cpu_s"], processed);
  return seconds ? std::optional(1000 * *seconds) : std::nullopt;
}

template <std::string_view const& Revised, std::string_view const& Online>
std::optional<double> revised_or_online(const RunNumbers& numbers) {
  const auto revised = numbers[Revised];
  return revised ? revised : numbers[Online];
}
constexpr std::string_view kAte = "ate_rmse_m", kAteRevised = "ate_revised_m";
constexpr std::string_view kRpe = "rpe_1s_m", kRpeRevised = "rpe_1s_revised_m";
constexpr std::string_view kSilent = "silent_failures", kSilentRevised = "silent_failures_revised";

/// What a row is called: in files and gates, as a column, and on the command line (empty: the key alone).
struct Names {
  std::string_view key;
  std::string_view heading;
  std::string_view word = {};
};
/// How a number is shown.
struct Shown {
  std::string_view unit;  ///< of the number itself
  double factor = 1;
  int decimals = 2;
};
constexpr Shown kInCentimetres{"m", 100}, kInMillimetres{"m", 1000}, kInDegrees{"rad", kDegreesPerRadian};
constexpr Shown kInMilliseconds{"s", 1000, 1}, kPercent{"1", 100, 1}, kRatio{"1"}, kFrames{"frames", 1, 0};
/// What tables and gates do with a number; see RunMetric.
struct Use {
  Better better = Better::smaller;
  MetricKind kind = estimate;
  Column columns = none;
  bool of_every_run = false;
  std::optional<double> tolerance = RunMetric{}.tolerance;
};
constexpr RunMetric row(const Names& names, const Shown& shown, const Use& use, std::string_view definition,
                        std::string_view path, Value (*of)(const record::RunRecord& record)) {
  return {.key = names.key,
          .word = names.word,
          .unit = shown.unit,
          .heading = names.heading,
          .shown_factor = shown.factor,
          .decimals = shown.decimals,
          .better = use.better,
          .kind = use.kind,
          .columns = use.columns,
          .of_every_run = use.of_every_run,
          .tolerance = use.tolerance,
          .definition = definition,
          .path = path,
          .of = of};
}
/// Of other numbers of the run; from: null for what takes several runs.
constexpr RunMetric derived_row(const Names& names, const Shown& shown, const Use& use,
                                std::string_view definition,
                                std::optional<double> (*from)(const RunNumbers& numbers)) {
  RunMetric metric = row(names, shown, use, definition, "", nullptr);
  metric.from = from;
  return metric;
}
/// A count of frames.
constexpr RunMetric frames_row(const Names& names, Column columns, std::optional<double> tolerance,
                               std::string_view definition, std::string_view path,
                               Value (*of)(const record::RunRecord& record),
                               Better better = Better::smaller) {
  return row(names, kFrames, {better, count, columns, true, tolerance}, definition, path, of);
}
constexpr RunMetric nees_row(const Names& names, int dof, std::string_view definition, std::string_view path,
                             Value (*of)(const record::RunRecord& record)) {
  RunMetric metric = row(names, kRatio, {.better = Better::neither, .columns = study}, definition, path, of);
  metric.nees_dof = dof;
  return metric;
}

constexpr auto kMetrics = std::to_array<RunMetric>({
    // Intensities of tracked patches.
    row({"aie_grey", "AIE [grey]", "aie"}, {"grey", 1, 3}, {.columns = runs | study},
        "average intensity error in grey levels (0-255): mean over frames of the mean over "
        "visible pixels of "
        "tracked patches, before any rejection",
        "metrics.aie.aie",
        of<&Metrics::aie, &metrics::IntensityResult::all, &metrics::IntensitySummary::aie_grey>),
    derived_row({"aie_common_grey", "AIE common [grey]"}, {"grey", 1, 3},
                {.columns = runs | study, .tolerance = kNoGate},
                "the same on the pixels that all compared runs share", nullptr),
    // Positions and motions.
    row({"ate_rmse_m", "ATE [cm]", "ate"}, kInCentimetres, {.columns = runs | systems | study},
        "absolute trajectory error: root mean square distance of positions after SE3 alignment, stamps "
        "associated one to one within 0.02 s (TUM), of frames that have a pose",
        "metrics.ate.stats.rmse", of<&Metrics::ate, &Ate::stats, &Statistics::rmse>),
    row({"ate_fitted_m", "ATE fitted [cm]", "ate-fitted"}, kInCentimetres, {.columns = runs | study},
        "ATE after the position of the camera in the body of the reference was fitted as well; absent "
        "where the motion does not determine it",
        "metrics.ate_fitted_offset.stats.rmse",
        of<&Metrics::ate_fitted, &trajectory_error::FittedOffset::stats, &Statistics::rmse>),
    derived_row({"ate_final_m", "ATE final [cm]", "ate-final"}, kInCentimetres,
                {.columns = systems | study, .tolerance = kNoGate},
                "ATE of the poses as the system revised them at the end; of a system that does not, its ATE",
                revised_or_online<kAteRevised, kAte>),
    row({kAteRevised, "ATE revised [cm]"}, kInCentimetres, {},
        "ATE of the poses as the system revised them at the end; absent if it did not",
        "final_metrics.ate.stats.rmse", revised<&Metrics::ate, &Ate::stats, &Statistics::rmse>),
    row({"rpe_1s_m", "RPE [cm/s]", "rpe"}, kInCentimetres, {.columns = runs | systems | study},
        "relative pose error: root mean square of the translation of (G_i^-1 G_j)^-1 (P_i^-1 P_j) over one "
        "second (TUM, fixed delta), not aligned",
        "metrics.rpe.second.translation.stats.rmse",
        of<&Metrics::rpe_second, &Rpe::translation, &Statistics::rmse>),
    row({"rpe_1s_rad", "RPE [deg/s]", "rpe-rotation"}, kInDegrees, {.columns = runs | study},
        "the rotation angle of the same, root mean square", "metrics.rpe.second.rotation.stats.rmse",
        of<&Metrics::rpe_second, &Rpe::rotation, &Statistics::rmse>),
    row({"rpe_frame_m", "RPE frame [mm]", "rpe-frame"}, kInMillimetres, {.columns = study},
        "relative pose error over one frame, translation, root mean square",
        "metrics.rpe.frame.translation.stats.rmse",
        of<&Metrics::rpe_frame, &Rpe::translation, &Statistics::rmse>),
    row({"rpe_frame_rad", "RPE frame [deg]"}, {"rad", kDegreesPerRadian, 3}, {.columns = study},
        "relative pose error over one frame, rotation, root mean square",
        "metrics.rpe.frame.rotation.stats.rmse", of<&Metrics::rpe_frame, &Rpe::rotation, &Statistics::rmse>),
    row({kRpeRevised, "RPE revised [cm/s]"}, kInCentimetres, {},
        "rpe_1s_m of the poses as the system revised them at the end; absent if it did not",
        "final_metrics.rpe.second.translation.stats.rmse",
        revised<&Metrics::rpe_second, &Rpe::translation, &Statistics::rmse>),
    derived_row({"rpe_1s_final_m", "RPE final [cm/s]"}, kInCentimetres, {.tolerance = kNoGate},
                "the same; of a system that does not revise its poses, its rpe_1s_m",
                revised_or_online<kRpeRevised, kRpe>),
    // Poses that were claimed and are wrong, and poses that there are none of.
    frames_row(
        {"silent_failures", "undetected", "silent"}, systems | study, kExact,
        "undetected failures: frames with a pose whose motion over the second before is off by more than "
        "5 cm or 3 degrees (evaluation.silent_*)",
        "metrics.silent_failures.silent", of<&Metrics::silent, &Silent::failures, &Failures::silent>),
    frames_row({"silent_judged", "judged"}, none, kNoGate,
               "frames with a pose for which the true motion over the second before is known",
               "metrics.silent_failures.judged", of<&Metrics::silent, &Silent::failures, &Failures::judged>,
               kNeither),
    derived_row({"silent_share", "undetected [%]", "silent-share"}, {"1", 100},
                {.columns = study, .of_every_run = true, .tolerance = kNoGate},
                "silent_failures / silent_judged",
                [](const RunNumbers& n) { return ratio(n["silent_failures"], n["silent_judged"]); }),
    frames_row({kSilentRevised, "undetected revised"}, none, kExact,
               "silent_failures of the poses as the system revised them at the end; absent if it did not",
               "final_metrics.silent_failures.silent",
               revised<&Metrics::silent, &Silent::failures, &Failures::silent>),
    derived_row({"silent_failures_final", "undetected final"}, kFrames,
                {.kind = count, .of_every_run = true, .tolerance = kNoGate},
                "the same; of a system that does not revise its poses, its silent_failures",
                revised_or_online<kSilentRevised, kSilent>),
    row({"coverage", "tracked [%]", "tracked"}, kPercent,
        {.better = kLarger,
         .kind = count,
         .columns = systems | study,
         .of_every_run = true,
         .tolerance = kExact},
        "frames with a pose / frames that were requested; 0 of a run that did not begin",
        "metrics.coverage.share", coverage),
    frames_row({"frames_tracked", "tracked"}, none, kExact, "frames with a pose, the first included",
               "frames.tracked", frame_count<&record::RecordedFrames::tracked>, kLarger),
    frames_row({"frames_lost", "lost frames"}, study, kNoGate, "frames that were processed and have no pose",
               "frames.lost", frame_count<&record::RecordedFrames::lost>),
    frames_row({"frames_other_segments", "in other segments"}, none, kNoGate,
               "frames tracked apart from the map, in segments that begin while the camera is lost",
               "frames.other_segments", frame_count<&record::RecordedFrames::other_segments>),
    row({"segments", "segments"}, {"segments", 1, 0},
        {.kind = count, .of_every_run = true, .tolerance = kNoGate},
        "stretches that were tracked apart from the map", "frames.segments",
        frame_count<&record::RecordedFrames::segments>),
    row({"segments_joined", "segments joined"}, {"segments", 1, 0},
        {.better = kLarger, .kind = count, .of_every_run = true, .tolerance = kNoGate},
        "segments in which a place of the map was recognised; their final poses are in the map",
        "frames.segments_joined", frame_count<&record::RecordedFrames::segments_joined>),
    frames_row({"frames_total", "frames"}, none, kExact, "frames that were requested", "frames.total",
               frame_count<&record::RecordedFrames::total>, kNeither),
    row({"runs_not_ok", "not ok"}, {"1", 1, 0},
        {.kind = count, .columns = study, .of_every_run = true, .tolerance = kNoGate},
        "1 of a run that was lost or failed, else 0", "", not_ok),
    // The clock of the ground truth.
    row({"reference_offset_s", "clock offset [ms]"}, kInMilliseconds,
        {.better = kNeither, .tolerance = kNoGate},
        "fitted constant offset of the ground truth's clock, t_reference - t_estimate; absent where the "
        "motion does not make it observable",
        "metrics.reference_clock.offset_s",
        of<&Metrics::reference_clock, &Clock::offset, &reference_clock::TimeOffset::offset_s>),
    row({"reference_offset_sigma_s", "clock sigma [ms]"}, kInMilliseconds,
        {.better = kNeither, .tolerance = kNoGate}, "its standard deviation",
        "metrics.reference_clock.sigma_s",
        of<&Metrics::reference_clock, &Clock::offset, &reference_clock::TimeOffset::sigma_s>),
    row({"ate_clock_fitted_m", "ATE clock fitted [cm]", "ate-clock"}, kInCentimetres, {.tolerance = kNoGate},
        "ATE with the fitted offset of the clock, whether the main numbers have it or not",
        "metrics.reference_clock.fitted.ate_rmse_m",
        of_fitted_clock<&reference_clock::ClockedErrors::ate_rmse_m>),
    row({"silent_failures_clock_fitted", "undetected, clock fitted"}, kFrames,
        {.kind = count, .tolerance = kNoGate}, "silent_failures with the fitted offset of the clock",
        "metrics.reference_clock.fitted.silent_failures",
        of_fitted_clock<&reference_clock::ClockedErrors::silent>),
    // Intensities by poses, and residuals.
    row({"pose_aie_grey", "AIE of poses [grey]", "pose-aie"}, {"grey"}, {.columns = systems},
        "intensity error of the poses alone, by probe patches that depend on no estimate "
        "(evaluation.pose_intensity)",
        "metrics.pose_intensity.aie_grey",
        of<&Metrics::pose_intensity, &record::RecordedPoseIntensity::aie_grey>),
    row({"chi2_photometric", "chi2 photometric"}, kRatio, {.better = kNeither},
        "mean squared whitened photometric residual of accepted patches: 1 where the noise model is right",
        "metrics.residuals.chi2_photometric",
        of<&Metrics::residuals, &metrics::ResidualSummary::chi2_photometric>),
    row({"chi2_geometric", "chi2 geometric"}, kRatio, {.better = kNeither},
        "mean squared whitened geometric residual of accepted patches: 1 where the noise model is right",
        "metrics.residuals.chi2_geometric",
        of<&Metrics::residuals, &metrics::ResidualSummary::chi2_geometric>),
    row({"accepted_share", "patches accepted [%]"}, kPercent, {.better = kNeither},
        "patches that the update accepted / patches that were tracked, mean over frames",
        "metrics.residuals.accepted_share",
        of<&Metrics::residuals, &metrics::ResidualSummary::accepted_share>),
    // Surfaces, aligned by all poses.
    row({"mesh_accuracy_m", "mesh accuracy [mm]", "mesh"}, kInMillimetres, {.columns = systems | study},
        "mean distance from samples of the reconstruction to the true surface, aligned by all poses",
        "metrics.mesh.accuracy.mean",
        of<&Metrics::mesh, &Mesh::poses, &MeshErrors::accuracy, &Distances::stats, &Statistics::mean>),
    row({"mesh_completeness_m", "mesh completeness [mm]", "mesh-completeness"}, kInMillimetres, {},
        "mean distance from observed samples of the true surface to the reconstruction, aligned "
        "by all poses",
        "metrics.mesh.completeness.mean",
        of<&Metrics::mesh, &Mesh::poses, &MeshErrors::completeness, &Distances::stats, &Statistics::mean>),
    row({"mesh_chamfer_m", "mesh chamfer [mm]"}, kInMillimetres, {},
        "mean of mesh_accuracy_m and mesh_completeness_m", "metrics.mesh.chamfer_m",
        of<&Metrics::mesh, &Mesh::poses, &MeshErrors::chamfer_m>),
    row({"mesh_fscore", "mesh F-score [%]"}, kPercent, {.better = kLarger},
        "harmonic mean of precision and recall: shares of the samples of the reconstruction and "
        "of the ground truth that are within the first threshold (5 mm) of the other",
        "metrics.mesh.thresholds.0.fscore", mesh_fscore),
    row({"mesh_ghost_share", "ghosts [%]"}, {"1", 100}, {},
        "samples of the reconstruction more than 3 cm from the ground truth in space that a true camera sees "
        "to be free / all samples",
        "metrics.mesh.ghost_share", mesh_ghosts),
    row({"model_vertices", "vertices"}, {"vertices", 1, 0},
        {.better = kNeither, .kind = count, .tolerance = kExact}, "vertices of the reconstruction",
        "model.vertices", model_vertices),
    // Claimed uncertainties.
    nees_row({"nees_orientation", "NEES orientation"}, 3,
             "normalised estimation error squared, error^T covariance^-1 error / dimensions, mean over "
             "frames: 1 is "
             "consistent, more is overconfident; of the orientation",
             "metrics.nees.orientation.mean", nees<0>),
    nees_row({"nees_position", "NEES position"}, 3, "the same of the position", "metrics.nees.position.mean",
             nees<1>),
    nees_row({"nees_velocity", "NEES velocity"}, 3, "the same of the velocity", "metrics.nees.velocity.mean",
             nees<2>),
    nees_row({"nees_gyroscope_bias", "NEES gyro bias"}, 3, "the same of the gyroscope's bias",
             "metrics.nees.gyroscope_bias.mean", nees<3>),
    nees_row({"nees_accelerometer_bias", "NEES accel bias"}, 3, "the same of the accelerometer's bias",
             "metrics.nees.accelerometer_bias.mean", nees<4>),
    nees_row({"nees_pose", "NEES pose"}, 6, "the same of position and orientation together",
             "metrics.nees.pose.mean", nees<5>),
    // Loops.
    row({"loops_accepted", "loops"}, {"loops", 1, 0},
        {.better = kNeither, .kind = count, .tolerance = kExact}, "loops that were closed",
        "loops.error.accepted", of_loops<&loop_error::LoopError::accepted>),
    row({"loops_false", "false loops"}, {"loops", 1, 0}, {.kind = count, .tolerance = kExact},
        "closed loops that are off by more than 5 cm or 2 degrees and by more than three of their sigmas",
        "loops.error.false_accepted", of_loops<&loop_error::LoopError::false_accepted>),
    // Costs.
    derived_row({"cpu_ms_per_frame", "CPU [ms/frame]", "cpu-frame"}, {"ms", 1, 1},
                {.kind = cost, .columns = systems, .tolerance = 0.10},
                "user and system time of all threads / frames that were processed", cpu_ms_per_frame),
    row({"cpu_s", "CPU [s]", "cpu"}, {"s"}, {.kind = cost, .tolerance = kNoGate},
        "user and system time of all threads", "timing.cpu_s", timed<&record::RecordedTiming::cpu_s>),
    row({"wall_s", "wall clock [s]", "wall"}, {"s"}, {.kind = cost, .tolerance = 0.25},
        "time that the run took", "timing.wall_s", timed<&record::RecordedTiming::wall_s>),
    row({"peak_rss_bytes", "memory [MB]", "memory"}, {"bytes", 1e-6, 0},
        {.kind = cost, .columns = systems, .tolerance = 0.10}, "largest resident memory",
        "timing.peak_rss_bytes", timed<&record::RecordedTiming::peak_rss_bytes>),
    row({"fps", "fps"}, {"1/s", 1, 1},
        {.better = kLarger, .kind = cost, .columns = study, .tolerance = kNoGate},
        "processed frames / wall_s, reading and evaluation included", "timing.fps",
        timed<&record::RecordedTiming::fps>),
});
static_assert(kMetrics.size() == kMetricCount);

constexpr std::size_t kMostColumns = kMetricCount;

/// The rows that are columns of a table.
struct TableColumns {
  std::array<const RunMetric*, kMostColumns> rows{};
  std::size_t count = 0;

  explicit constexpr TableColumns(Column table) {
    for (const RunMetric& metric : kMetrics) {
      if (metric.is_column_of(table)) rows[count++] = &metric;
    }
  }
  [[nodiscard]] std::span<const RunMetric* const> span() const { return {rows.data(), count}; }
};

}  // namespace

std::string_view to_string(Better better) {
  switch (better) {
    case Better::smaller:
      return "smaller";
    case Better::larger:
      return "larger";
    case Better::neither:
      break;
  }
  return "equal";
}

std::span<const RunMetric> run_metrics() { return kMetrics; }

const RunMetric* find_metric(std::string_view key) {
  const auto* const found = std::ranges::find(kMetrics, key, &RunMetric::key);
  return found == kMetrics.end() ? nullptr : found;
}

const RunMetric& run_metric(std::string_view key) {
  const RunMetric* const found = find_metric(key);
  check(found != nullptr, "a metric of that key exists");
  return *found;
}

std::size_t index_of(const RunMetric& metric) { return static_cast<std::size_t>(&metric - kMetrics.data()); }

Result<const RunMetric*> find_ranking_metric(std::string_view name) {
  std::vector<std::string> allowed;
  for (const RunMetric& metric : kMetrics) {
    if (metric.better != Better::smaller || metric.takes_several_runs()) continue;
    if (name == metric.key || (!metric.word.empty() && name == metric.word)) return &metric;
    allowed.emplace_back(metric.word.empty() ? metric.key : metric.word);
  }
  return fail(ErrorCode::usage, fmt::format("{} is no metric to rank by (allowed: {}){}", name,
                                            fmt::join(allowed, " | "), nearest_hint(name, allowed)));
}

std::span<const RunMetric* const> columns_of(Column table) {
  static constexpr TableColumns kRuns(runs), kSystems(systems), kStudy(study);
  check(table == runs || table == systems || table == study, "columns of one table");
  return (table == runs ? kRuns : table == systems ? kSystems : kStudy).span();
}

std::string shown_text(const RunMetric& metric, double value) {
  return fmt::format("{:.{}f}", value * metric.shown_factor, metric.decimals);
}

}  // namespace fusebench::registry
