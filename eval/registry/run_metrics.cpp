#include "eval/registry/run_metric.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/nearest_name.hpp"
#include "eval/registry/recorded_values.hpp"
#include "eval/registry/run_numbers.hpp"

namespace fusebench::registry {

namespace {

using enum Column;
using enum MetricKind;
using Rpe = trajectory_error::RpeResult;
using Residuals = metrics::ResidualSummary;

constexpr auto kLarger = Better::larger;
constexpr auto kNeither = Better::neither;
constexpr std::nullopt_t kNoGate = std::nullopt;
constexpr double kCentimetres = 100;
constexpr double kMillimetres = 1000;
constexpr double kMilliseconds = 1000;
constexpr double kPercent = 100;
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

constexpr auto kMetrics = std::to_array<RunMetric>({
    // Intensities of tracked patches.
    {.key = "aie_grey",
     .word = "aie",
     .unit = "grey",
     .heading = "AIE [grey]",
     .decimals = 3,
     .columns = runs | study,
     .definition = "average intensity error in grey levels (0-255): mean over frames of the mean over "
                   "visible pixels of "
                   "tracked patches, before any rejection",
     .path = "metrics.aie.aie",
     .of = aie},
    {.key = "aie_common_grey",
     .unit = "grey",
     .heading = "AIE common [grey]",
     .decimals = 3,
     .columns = runs | study,
     .tolerance = kNoGate,
     .definition = "the same on the pixels that all compared runs share"},
    // Positions and motions.
    {.key = "ate_rmse_m",
     .word = "ate",
     .unit = "m",
     .heading = "ATE [cm]",
     .shown_factor = kCentimetres,
     .columns = runs | systems | study,
     .definition =
         "absolute trajectory error: root mean square distance of positions after SE3 alignment, stamps "
         "associated one to one within 0.02 s (TUM), of frames that have a pose",
     .path = "metrics.ate.stats.rmse",
     .of = ate},
    {.key = "ate_fitted_m",
     .word = "ate-fitted",
     .unit = "m",
     .heading = "ATE fitted [cm]",
     .shown_factor = kCentimetres,
     .columns = runs | study,
     .definition =
         "ATE after the position of the camera in the body of the reference was fitted as well; absent "
         "where the motion does not determine it",
     .path = "metrics.ate_fitted_offset.stats.rmse",
     .of = ate_fitted},
    {.key = "ate_final_m",
     .word = "ate-final",
     .unit = "m",
     .heading = "ATE final [cm]",
     .shown_factor = kCentimetres,
     .columns = systems | study,
     .tolerance = kNoGate,
     .definition =
         "ATE of the poses as the system revised them at the end; of a system that does not, its ATE",
     .from = revised_or_online<kAteRevised, kAte>},
    {.key = kAteRevised,
     .unit = "m",
     .heading = "ATE revised [cm]",
     .shown_factor = kCentimetres,
     .definition = "ATE of the poses as the system revised them at the end; absent if it did not",
     .path = "final_metrics.ate.stats.rmse",
     .of = ate_revised},
    {.key = "rpe_1s_m",
     .word = "rpe",
     .unit = "m",
     .heading = "RPE [cm/s]",
     .shown_factor = kCentimetres,
     .columns = runs | systems | study,
     .definition =
         "relative pose error: root mean square of the translation of (G_i^-1 G_j)^-1 (P_i^-1 P_j) over one "
         "second (TUM, fixed delta), not aligned",
     .path = "metrics.rpe.second.translation.stats.rmse",
     .of = rpe<&Metrics::rpe_second, &Rpe::translation>},
    {.key = "rpe_1s_rad",
     .word = "rpe-rotation",
     .unit = "rad",
     .heading = "RPE [deg/s]",
     .shown_factor = kDegreesPerRadian,
     .columns = runs | study,
     .definition = "the rotation angle of the same, root mean square",
     .path = "metrics.rpe.second.rotation.stats.rmse",
     .of = rpe<&Metrics::rpe_second, &Rpe::rotation>},
    {.key = "rpe_frame_m",
     .word = "rpe-frame",
     .unit = "m",
     .heading = "RPE frame [mm]",
     .shown_factor = kMillimetres,
     .columns = study,
     .definition = "relative pose error over one frame, translation, root mean square",
     .path = "metrics.rpe.frame.translation.stats.rmse",
     .of = rpe<&Metrics::rpe_frame, &Rpe::translation>},
    {.key = "rpe_frame_rad",
     .unit = "rad",
     .heading = "RPE frame [deg]",
     .shown_factor = kDegreesPerRadian,
     .decimals = 3,
     .columns = study,
     .definition = "relative pose error over one frame, rotation, root mean square",
     .path = "metrics.rpe.frame.rotation.stats.rmse",
     .of = rpe<&Metrics::rpe_frame, &Rpe::rotation>},
    {.key = kRpeRevised,
     .unit = "m",
     .heading = "RPE revised [cm/s]",
     .shown_factor = kCentimetres,
     .definition = "rpe_1s_m of the poses as the system revised them at the end; absent if it did not",
     .path = "final_metrics.rpe.second.translation.stats.rmse",
     .of = rpe_revised},
    {.key = "rpe_1s_final_m",
     .unit = "m",
     .heading = "RPE final [cm/s]",
     .shown_factor = kCentimetres,
     .tolerance = kNoGate,
     .definition = "the same; of a system that does not revise its poses, its rpe_1s_m",
     .from = revised_or_online<kRpeRevised, kRpe>},
    // Poses that were claimed and are wrong, and poses that there are none of.
    {.key = "silent_failures",
     .word = "silent",
     .unit = "frames",
     .heading = "undetected",
     .decimals = 0,
     .kind = count,
     .columns = systems | study,
     .of_every_run = true,
     .tolerance = kExact,
     .definition =
         "undetected failures: frames with a pose whose motion over the second before is off by more than "
         "5 cm or 3 degrees (evaluation.silent_*)",
     .path = "metrics.silent_failures.silent",
     .of = silent},
    {.key = "silent_judged",
     .unit = "frames",
     .heading = "judged",
     .decimals = 0,
     .better = kNeither,
     .kind = count,
     .of_every_run = true,
     .tolerance = kNoGate,
     .definition = "frames with a pose for which the true motion over the second before is known",
     .path = "metrics.silent_failures.judged",
     .of = silent_judged},
    {.key = "silent_share",
     .word = "silent-share",
     .unit = "1",
     .heading = "undetected [%]",
     .shown_factor = kPercent,
     .columns = study,
     .of_every_run = true,
     .tolerance = kNoGate,
     .definition = "silent_failures / silent_judged",
     .from = [](const RunNumbers& n) { return ratio(n["silent_failures"], n["silent_judged"]); }},
    {.key = kSilentRevised,
     .unit = "frames",
     .heading = "undetected revised",
     .decimals = 0,
     .kind = count,
     .of_every_run = true,
     .tolerance = kExact,
     .definition = "silent_failures of the poses as the system revised them at the end; absent if it did not",
     .path = "final_metrics.silent_failures.silent",
     .of = silent_revised},
    {.key = "silent_failures_final",
     .unit = "frames",
     .heading = "undetected final",
     .decimals = 0,
     .kind = count,
     .of_every_run = true,
     .tolerance = kNoGate,
     .definition = "the same; of a system that does not revise its poses, its silent_failures",
     .from = revised_or_online<kSilentRevised, kSilent>},
    {.key = "coverage",
     .word = "tracked",
     .unit = "1",
     .heading = "tracked [%]",
     .shown_factor = kPercent,
     .decimals = 1,
     .better = kLarger,
     .kind = count,
     .columns = systems | study,
     .of_every_run = true,
     .tolerance = kExact,
     .definition = "frames with a pose / frames that the run was asked for; 0 of a run that did not begin",
     .path = "metrics.coverage.share",
     .of = [](const record::RunRecord& r) { return finite(record::coverage_share(r.frames)); }},
    {.key = "frames_tracked",
     .unit = "frames",
     .heading = "tracked",
     .decimals = 0,
     .better = kLarger,
     .kind = count,
     .of_every_run = true,
     .tolerance = kExact,
     .definition = "frames with a pose, the first included",
     .path = "frames.tracked",
     .of = [](const record::RunRecord& r) { return frame_count(r, r.frames.tracked); }},
    {.key = "frames_lost",
     .unit = "frames",
     .heading = "lost frames",
     .decimals = 0,
     .kind = count,
     .columns = study,
     .of_every_run = true,
     .tolerance = kNoGate,
     .definition = "frames that were processed and have no pose",
     .path = "frames.lost",
     .of = [](const record::RunRecord& r) { return frame_count(r, r.frames.lost); }},
    {.key = "frames_other_segments",
     .unit = "frames",
     .heading = "in other segments",
     .decimals = 0,
     .kind = count,
     .of_every_run = true,
     .tolerance = kNoGate,
     .definition = "frames tracked apart from the map, in segments that begin while the camera is lost",
     .path = "frames.other_segments",
     .of = [](const record::RunRecord& r) { return frame_count(r, r.frames.other_segments); }},
    {.key = "segments",
     .unit = "segments",
     .heading = "segments",
     .decimals = 0,
     .kind = count,
     .of_every_run = true,
     .tolerance = kNoGate,
     .definition = "stretches that were tracked apart from the map",
     .path = "frames.segments",
     .of = [](const record::RunRecord& r) { return frame_count(r, r.frames.segments); }},
    {.key = "segments_joined",
     .unit = "segments",
     .heading = "segments joined",
     .decimals = 0,
     .better = kLarger,
     .kind = count,
     .of_every_run = true,
     .tolerance = kNoGate,
     .definition = "segments in which a place of the map was recognised; their final poses are in the map",
     .path = "frames.segments_joined",
     .of = [](const record::RunRecord& r) { return frame_count(r, r.frames.segments_joined); }},
    {.key = "frames_total",
     .unit = "frames",
     .heading = "frames",
     .decimals = 0,
     .better = kNeither,
     .kind = count,
     .of_every_run = true,
     .tolerance = kExact,
     .definition = "frames that the run was asked for",
     .path = "frames.total",
     .of = [](const record::RunRecord& r) { return frame_count(r, r.frames.total); }},
    {.key = "runs_not_ok",
     .unit = "1",
     .heading = "not ok",
     .decimals = 0,
     .kind = count,
     .columns = study,
     .of_every_run = true,
     .tolerance = kNoGate,
     .definition = "1 of a run that was lost or failed, else 0",
     .of = [](const record::RunRecord& r) { return counted(r.status == record::RunStatus::ok ? 0 : 1); }},
    // The clock of the ground truth.
    {.key = "reference_offset_s",
     .unit = "s",
     .heading = "clock offset [ms]",
     .shown_factor = kMilliseconds,
     .decimals = 1,
     .better = kNeither,
     .tolerance = kNoGate,
     .definition =
         "fitted constant offset of the ground truth's clock, t_reference - t_estimate; absent where the "
         "motion does not make it observable",
     .path = "metrics.reference_clock.offset_s",
     .of =
         [](const record::RunRecord& r) {
           return of_clock(r, [](const auto& m) { return m.offset.offset_s; });
         }},
    {.key = "reference_offset_sigma_s",
     .unit = "s",
     .heading = "clock sigma [ms]",
     .shown_factor = kMilliseconds,
     .decimals = 1,
     .better = kNeither,
     .tolerance = kNoGate,
     .definition = "its standard deviation",
     .path = "metrics.reference_clock.sigma_s",
     .of =
         [](const record::RunRecord& r) {
           return of_clock(r, [](const auto& m) { return m.offset.sigma_s; });
         }},
    {.key = "ate_clock_fitted_m",
     .word = "ate-clock",
     .unit = "m",
     .heading = "ATE clock fitted [cm]",
     .shown_factor = kCentimetres,
     .tolerance = kNoGate,
     .definition = "ATE with the fitted offset of the clock, whether the main numbers have it or not",
     .path = "metrics.reference_clock.fitted.ate_rmse_m",
     .of =
         [](const record::RunRecord& r) {
           return of_fitted_clock(r, &reference_clock::ClockedErrors::ate_rmse_m);
         }},
    {.key = "silent_failures_clock_fitted",
     .unit = "frames",
     .heading = "undetected, clock fitted",
     .decimals = 0,
     .kind = count,
     .tolerance = kNoGate,
     .definition = "silent_failures with the fitted offset of the clock",
     .path = "metrics.reference_clock.fitted.silent_failures",
     .of =
         [](const record::RunRecord& r) {
           return of_fitted_clock(r, &reference_clock::ClockedErrors::silent);
         }},
    // Intensities by poses, and residuals.
    {.key = "pose_aie_grey",
     .word = "pose-aie",
     .unit = "grey",
     .heading = "AIE of poses [grey]",
     .columns = systems,
     .definition = "intensity error of the poses alone, by probe patches that depend on no estimate "
                   "(evaluation.pose_intensity)",
     .path = "metrics.pose_intensity.aie_grey",
     .of = pose_aie},
    {.key = "chi2_photometric",
     .unit = "1",
     .heading = "chi2 photometric",
     .better = kNeither,
     .definition =
         "mean squared whitened photometric residual of accepted patches: 1 where the noise model is right",
     .path = "metrics.residuals.chi2_photometric",
     .of = residual<&Residuals::chi2_photometric>},
    {.key = "chi2_geometric",
     .unit = "1",
     .heading = "chi2 geometric",
     .better = kNeither,
     .definition =
         "mean squared whitened geometric residual of accepted patches: 1 where the noise model is right",
     .path = "metrics.residuals.chi2_geometric",
     .of = residual<&Residuals::chi2_geometric>},
    {.key = "accepted_share",
     .unit = "1",
     .heading = "patches accepted [%]",
     .shown_factor = kPercent,
     .decimals = 1,
     .better = kNeither,
     .definition = "patches that the update accepted / patches that were tracked, mean over frames",
     .path = "metrics.residuals.accepted_share",
     .of = residual<&Residuals::accepted_share>},
    // Surfaces, aligned by all poses.
    {.key = "mesh_accuracy_m",
     .word = "mesh",
     .unit = "m",
     .heading = "mesh accuracy [mm]",
     .shown_factor = kMillimetres,
     .columns = systems | study,
     .definition =
         "mean distance from samples of the reconstruction to the true surface, aligned by all poses",
     .path = "metrics.mesh.accuracy.mean",
     .of = mesh_accuracy},
    {.key = "mesh_completeness_m",
     .word = "mesh-completeness",
     .unit = "m",
     .heading = "mesh completeness [mm]",
     .shown_factor = kMillimetres,
     .definition = "mean distance from observed samples of the true surface to the reconstruction, aligned "
                   "by all poses",
     .path = "metrics.mesh.completeness.mean",
     .of = mesh_completeness},
    {.key = "mesh_chamfer_m",
     .unit = "m",
     .heading = "mesh chamfer [mm]",
     .shown_factor = kMillimetres,
     .definition = "mean of mesh_accuracy_m and mesh_completeness_m",
     .path = "metrics.mesh.chamfer_m",
     .of = mesh_chamfer},
    {.key = "mesh_fscore",
     .unit = "1",
     .heading = "mesh F-score [%]",
     .shown_factor = kPercent,
     .decimals = 1,
     .better = kLarger,
     .definition = "harmonic mean of precision and recall: shares of the samples of the reconstruction and "
                   "of the truth "
                   "that are within the first threshold (5 mm) of the other",
     .path = "metrics.mesh.thresholds.0.fscore",
     .of = mesh_fscore},
    {.key = "mesh_ghost_share",
     .unit = "1",
     .heading = "ghosts [%]",
     .shown_factor = kPercent,
     .definition =
         "samples of the reconstruction more than 3 cm from the truth in space that a true camera sees to be "
         "free / all samples",
     .path = "metrics.mesh.ghost_share",
     .of = mesh_ghosts},
    {.key = "model_vertices",
     .unit = "vertices",
     .heading = "vertices",
     .decimals = 0,
     .better = kNeither,
     .kind = count,
     .tolerance = kExact,
     .definition = "vertices of the reconstruction",
     .path = "model.vertices",
     .of = [](const record::RunRecord& r) { return model_vertices(r); }},
    // Claimed uncertainties.
    {.key = "nees_orientation",
     .unit = "1",
     .heading = "NEES orientation",
     .better = kNeither,
     .columns = study,
     .nees_dof = 3,
     .definition = "normalised estimation error squared, error^T covariance^-1 error / dimensions, mean over "
                   "frames: 1 is "
                   "consistent, more is overconfident; of the orientation",
     .path = "metrics.nees.orientation.mean",
     .of = nees<0>},
    {.key = "nees_position",
     .unit = "1",
     .heading = "NEES position",
     .better = kNeither,
     .columns = study,
     .nees_dof = 3,
     .definition = "the same of the position",
     .path = "metrics.nees.position.mean",
     .of = nees<1>},
    {.key = "nees_velocity",
     .unit = "1",
     .heading = "NEES velocity",
     .better = kNeither,
     .columns = study,
     .nees_dof = 3,
     .definition = "the same of the velocity",
     .path = "metrics.nees.velocity.mean",
     .of = nees<2>},
    {.key = "nees_gyroscope_bias",
     .unit = "1",
     .heading = "NEES gyro bias",
     .better = kNeither,
     .columns = study,
     .nees_dof = 3,
     .definition = "the same of the gyroscope's bias",
     .path = "metrics.nees.gyroscope_bias.mean",
     .of = nees<3>},
    {.key = "nees_accelerometer_bias",
     .unit = "1",
     .heading = "NEES accel bias",
     .better = kNeither,
     .columns = study,
     .nees_dof = 3,
     .definition = "the same of the accelerometer's bias",
     .path = "metrics.nees.accelerometer_bias.mean",
     .of = nees<4>},
    {.key = "nees_pose",
     .unit = "1",
     .heading = "NEES pose",
     .better = kNeither,
     .columns = study,
     .nees_dof = 6,
     .definition = "the same of position and orientation together",
     .path = "metrics.nees.pose.mean",
     .of = nees<5>},
    // Loops.
    {.key = "loops_accepted",
     .unit = "loops",
     .heading = "loops",
     .decimals = 0,
     .better = kNeither,
     .kind = count,
     .tolerance = kExact,
     .definition = "loops that were closed",
     .path = "loops.error.accepted",
     .of = loops_accepted},
    {.key = "loops_false",
     .unit = "loops",
     .heading = "false loops",
     .decimals = 0,
     .kind = count,
     .tolerance = kExact,
     .definition =
         "closed loops that are off by more than 5 cm or 2 degrees and by more than three of their sigmas",
     .path = "loops.error.false_accepted",
     .of = loops_false},
    // Costs.
    {.key = "cpu_ms_per_frame",
     .word = "cpu-frame",
     .unit = "ms",
     .heading = "CPU [ms/frame]",
     .decimals = 1,
     .kind = cost,
     .columns = systems,
     .tolerance = 0.10,
     .definition = "user and system time of all threads / frames that were processed",
     .from = cpu_ms_per_frame},
    {.key = "cpu_s",
     .word = "cpu",
     .unit = "s",
     .heading = "CPU [s]",
     .kind = cost,
     .tolerance = kNoGate,
     .definition = "user and system time of all threads",
     .path = "timing.cpu_s",
     .of = [](const record::RunRecord& r) { return positive(r.timing.cpu_s); }},
    {.key = "wall_s",
     .word = "wall",
     .unit = "s",
     .heading = "wall clock [s]",
     .kind = cost,
     .tolerance = 0.25,
     .definition = "time that the run took",
     .path = "timing.wall_s",
     .of = [](const record::RunRecord& r) { return positive(r.timing.wall_s); }},
    {.key = "peak_rss_bytes",
     .word = "memory",
     .unit = "bytes",
     .heading = "memory [MB]",
     .shown_factor = 1e-6,
     .decimals = 0,
     .kind = cost,
     .columns = systems,
     .tolerance = 0.10,
     .definition = "largest resident memory",
     .path = "timing.peak_rss_bytes",
     .of = [](const record::RunRecord& r) { return positive(static_cast<double>(r.timing.peak_rss_bytes)); }},
    {.key = "fps",
     .unit = "1/s",
     .heading = "fps",
     .decimals = 1,
     .better = kLarger,
     .kind = cost,
     .columns = study,
     .tolerance = kNoGate,
     .definition = "processed frames / wall_s, reading and evaluation included",
     .path = "timing.fps",
     .of = [](const record::RunRecord& r) { return positive(r.timing.fps); }},
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
