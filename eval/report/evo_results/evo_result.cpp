#include "eval/report/evo_results/evo_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "eval/metrics/trajectory_files/stamps.hpp"

namespace fusebench::evo_results {

namespace {

using trajectory_error::AlignmentMode;
using trajectory_error::DeltaUnit;
using trajectory_error::MotionRule;
using trajectory_error::PoseRelation;

/// As evo's PoseRelation spells it out.
std::string_view spelled_out(PoseRelation relation) {
  switch (relation) {
    case PoseRelation::translation:
      return "translation part";
    case PoseRelation::point_distance:
      return "point distance";
    case PoseRelation::distance_error_ratio:
      return "point distance error ratio";
    case PoseRelation::rotation_part:
      return "rotation part";
    case PoseRelation::angle_rad:
      return "rotation angle in radians";
    case PoseRelation::angle_deg:
      return "rotation angle in degrees";
    case PoseRelation::full:
      return "full transformation";
  }
  return "";
}

std::string_view unit_name(DeltaUnit unit) {
  switch (unit) {
    case DeltaUnit::frames:
      return "frames";
    case DeltaUnit::metres:
      return "m";
    case DeltaUnit::degrees:
      return "deg";
    case DeltaUnit::radians:
      return "rad";
    case DeltaUnit::seconds:
      return "s";
  }
  return "";
}

/// As Python prints it: frames are an int, all else is a float.
std::string delta_text(const trajectory_error::Delta& delta) {
  const bool whole = std::floor(delta.value) == delta.value && std::abs(delta.value) < 1e15;
  if (delta.unit != DeltaUnit::frames && whole) return fmt::format("{:.1f}", delta.value);
  return fmt::format("{}", delta.value);
}

std::string motions_text(const trajectory_error::TrajectoryRequest& request) {
  switch (request.motions) {
    case MotionRule::segments:
      return "\nfor segments of several lengths";
    case MotionRule::each_to_each:
      return "\nfor every pose with every pose";
    case MotionRule::fixed_delta:
    case MotionRule::all:
    case MotionRule::consecutive:
      break;
  }
  const char* const pairs = request.motions == MotionRule::all           ? "all pairs"
                            : request.motions == MotionRule::fixed_delta ? "pairs from every pose"
                                                                         : "consecutive pairs";
  return fmt::format("\nfor delta = {} ({}) using {}", delta_text(request.delta),
                     unit_name(request.delta.unit), pairs);
}

std::string alignment_text(const trajectory_error::AlignmentRequest& alignment) {
  switch (alignment.mode) {
    case AlignmentMode::none:
      return "\n(not aligned)";
    case AlignmentMode::se3:
      return "\n(with SE(3) Umeyama alignment)";
    case AlignmentMode::sim3:
      return "\n(with Sim(3) Umeyama alignment)";
    case AlignmentMode::scale:
      return "\n(scale corrected)";
    case AlignmentMode::yaw:
      return "\n(with yaw alignment)";
    case AlignmentMode::origin:
      return alignment.scale_origin ? "\n(scale corrected)\n(with origin alignment)"
                                    : "\n(with origin alignment)";
  }
  return "";
}

std::string title_of(const trajectory_error::TrajectoryEvaluation& evaluation, const std::string& metric) {
  const trajectory_error::TrajectoryRequest& request = evaluation.request;
  const trajectory_error::ErrorSeries& series = evaluation.series.front();
  const bool segments = !evaluation.segments.empty();
  std::string title =
      fmt::format("{} w.r.t. {} ({})", metric, segments ? series.relation : spelled_out(request.relation),
                  series.unit.empty() ? "unit-less" : series.unit);
  if (request.metric == trajectory_error::TrajectoryMetric::rpe) title += motions_text(request);
  title += alignment_text(request.alignment);
  if (request.alignment.first > 0 && request.alignment.mode != AlignmentMode::none)
    title += fmt::format(" (aligned poses: {})", request.alignment.first);
  if (request.plane != trajectory_error::Plane::none)
    title += fmt::format("\n(projected to {} plane)", trajectory_error::to_string(request.plane));
  if (request.protocol != trajectory_error::Protocol::evo)
    title += fmt::format("\n(by the protocol of {})", trajectory_error::to_string(request.protocol));
  return title;
}

/// The poses that errors belong to; of motions the first pose, too, which none ends at.
Trajectory selected(const Trajectory& poses, const std::vector<std::size_t>& at, bool with_first) {
  Trajectory kept;
  if (with_first && !poses.empty()) kept.push_back(poses.front());
  for (const std::size_t index : at) kept.push_back(poses[index]);
  return kept;
}

std::vector<double> seconds_of(const std::vector<std::int64_t>& stamps_ns) {
  std::vector<double> seconds;
  seconds.reserve(stamps_ns.size());
  std::ranges::transform(stamps_ns, std::back_inserter(seconds), trajectory_files::stamp_seconds);
  return seconds;
}

std::vector<double> since(std::vector<double> times_s, double start_s) {
  for (double& time_s : times_s) time_s -= start_s;
  return times_s;
}

/// Path up to each error's pose, along these poses.
std::vector<double> distances(const Trajectory& poses, std::size_t errors) {
  std::vector<double> path_m = trajectory_error::path_lengths(poses);
  path_m.erase(path_m.begin(), path_m.end() - static_cast<std::ptrdiff_t>(errors));
  return path_m;
}

NpyArray matrix_of(const trajectory_error::Similarity& alignment) {
  const Matrix3d R = alignment.scale * alignment.rigid.rotation_matrix();
  NpyArray matrix{{4, 4}, {}};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix.values.push_back(R(row, column));
    matrix.values.push_back(alignment.rigid.translation[row]);
  }
  matrix.values.insert(matrix.values.end(), {0, 0, 0, 1});
  return matrix;
}

}  // namespace

const NpyArray* EvoResult::array(std::string_view name) const {
  const auto found = std::ranges::find(arrays, name, [](const auto& entry) { return entry.first; });
  return found == arrays.end() ? nullptr : &found->second;
}

EvoResult result_of(const trajectory_error::TrajectoryEvaluation& evaluation, const EvaluatedFiles& files) {
  const bool motions = evaluation.request.metric == trajectory_error::TrajectoryMetric::rpe;
  const std::string metric = motions ? "RPE" : "APE";
  const trajectory_error::ErrorSeries& series = evaluation.series.front();
  check(!series.streamed && !evaluation.compared.estimate.empty(), "errors are listed, poses are kept");
  EvoResult result;
  result.title = title_of(evaluation, metric);
  result.reference_name = files.reference;
  result.estimate_name = files.estimate;
  result.label = fmt::format("{} ({})", metric, series.unit.empty() ? "unit-less" : series.unit);
  const metrics::Statistics& stats = series.stats;
  result.stats = {{"rmse", stats.rmse}, {"mean", stats.mean}, {"median", stats.median}, {"std", stats.std},
                  {"min", stats.min},   {"max", stats.max},   {"sse", stats.sse}};
  result.arrays.emplace_back("error_array", row_of(series.errors));
  Trajectory reference = evaluation.compared.reference;
  Trajectory estimate = evaluation.compared.estimate;
  if (!series.at.empty()) {
    reference = selected(reference, series.at, motions);
    estimate = selected(estimate, series.at, motions);
  }
  if (files.have_stamps) {
    std::vector<double> times_s = seconds_of(series.at_ns);
    const double start_s = trajectory_files::stamp_seconds(estimate.front().timestamp_ns);
    result.arrays.emplace_back("seconds_from_start", row_of(since(times_s, start_s)));
    result.arrays.emplace_back("timestamps", row_of(std::move(times_s)));
    if (!series.at.empty()) {
      result.arrays.emplace_back("distances_from_start", row_of(distances(reference, series.errors.size())));
      result.arrays.emplace_back("distances", row_of(distances(estimate, series.errors.size())));
    }
  }
  if (evaluation.request.alignment.mode != AlignmentMode::none)
    result.arrays.emplace_back("alignment_transformation_sim3", matrix_of(evaluation.alignment));
  result.trajectories.push_back({files.reference, std::move(reference), files.have_stamps});
  result.trajectories.push_back({files.estimate, std::move(estimate), files.have_stamps});
  return result;
}

}  // namespace fusebench::evo_results
