#include "eval/record/truth_contradiction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fusebench::record {

namespace {

constexpr std::string_view kWarning = "warning: ";
constexpr std::string_view kContradiction = "the poses contradict the ground truth: ";
constexpr double kMostError = 0.5;      // of the extent: a quarter of the variance
constexpr double kLeastExtent_m = 0.1;  // smaller motions and their errors are of one size
constexpr std::size_t kLeastPoses = 10;
constexpr std::string_view kCheckRecording = "`fusebench inspect` on the recording looks for the reason";
constexpr std::string_view kCheckPoses =
    "check the scale of the trajectory (`fusebench eval ate --align sim3`), the direction of its poses "
    "(`fusebench import --pose world_to_camera`) and its clock (`fusebench eval ate --fit-time-offset`)";

/// rms distance of the positions from their mean.
double extent_m(const Trajectory& trajectory) {
  Vector3d mean_m = Vector3d::Zero();
  const auto count = static_cast<double>(trajectory.size());
  for (const StampedPose& pose : trajectory) mean_m += pose.T_world_camera.translation / count;
  double squares_m2 = 0;
  for (const StampedPose& pose : trajectory)
    squares_m2 += (pose.T_world_camera.translation - mean_m).squaredNorm() / count;
  return std::sqrt(squares_m2);
}

std::optional<double> ate_rmse_m(const RecordedMetrics& metrics) {
  if (!metrics.ate.value) return std::nullopt;
  return metrics.ate.value->stats.rmse;
}

}  // namespace

std::optional<std::string> truth_contradiction(const Trajectory& truth, const Trajectory& estimate,
                                               std::optional<double> ate_rmse_m, bool foreign) {
  if (std::min(truth.size(), estimate.size()) < kLeastPoses) return std::nullopt;
  const double true_m = extent_m(truth), estimated_m = extent_m(estimate);
  const double error_m = ate_rmse_m.value_or(std::abs(estimated_m - true_m));
  if (!(error_m > kMostError * std::max(true_m, kLeastExtent_m))) return std::nullopt;
  const std::string measured = ate_rmse_m ? fmt::format("ATE {:.2f} m, and ", *ate_rmse_m) : "";
  return fmt::format(
      "{}{}its positions are within {:.2f} m (rms) of their mean, those of the run within {:.2f} "
      "m; {}",
      kContradiction, measured, true_m, estimated_m, foreign ? kCheckPoses : kCheckRecording);
}

void note_contradiction(RunRecord& record, const Trajectory& truth, const Trajectory& estimate) {
  if (record.status != RunStatus::ok) return;
  std::optional<double> error_m = ate_rmse_m(record.metrics);
  if (const auto final_m = record.final_metrics ? ate_rmse_m(*record.final_metrics) : std::nullopt)
    error_m = std::min(error_m.value_or(*final_m), *final_m);
  const bool foreign = record.config.empty() || record.program.has_value();
  if (const auto text = truth_contradiction(truth, estimate, error_m, foreign))
    record.recording.notes.push_back(std::string(kWarning) + *text);
}

bool is_contradiction(std::string_view note) {
  return note.starts_with(kWarning) && note.substr(kWarning.size()).starts_with(kContradiction);
}

std::optional<std::string> noted_contradiction(const RunRecord& record) {
  const auto note = std::ranges::find_if(record.recording.notes, is_contradiction);
  if (note == record.recording.notes.end()) return std::nullopt;
  return note->substr(kWarning.size());
}

}  // namespace fusebench::record
