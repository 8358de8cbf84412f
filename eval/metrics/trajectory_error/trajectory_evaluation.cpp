#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/trajectory/trajectory.hpp"
#include "core/base/trajectory/trajectory_extent.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/metrics/trajectory_error/segment_errors.hpp"
#include "eval/metrics/trajectory_files/stamps.hpp"
#include "eval/metrics/trajectory_files/trajectory_pair.hpp"

namespace fusebench::trajectory_error {

namespace {

ErrorSeries series_of(std::string relation, std::string unit, std::vector<double> errors,
                      std::vector<std::int64_t> at_ns) {
  const metrics::Statistics stats = metrics::statistics(errors);
  return {std::move(relation), std::move(unit), std::move(errors), std::move(at_ns), {}, {}, stats};
}

ErrorSeries series_of(TrajectoryError error) {
  return {std::string(to_string(error.relation)),
          std::string(unit_of(error.relation)),
          std::move(error.errors),
          std::move(error.at_ns),
          std::move(error.at),
          std::move(error.streamed),
          error.stats};
}

/// Every error times a factor.
void scale(ErrorSeries& series, double factor) {
  for (double& error : series.errors) error *= factor;
  if (series.streamed) {
    series.streamed = [unscaled = std::move(series.streamed), factor](const ValueVisitor& visit) {
      unscaled([&](double error) { visit(error * factor); });
    };
  }
  series.stats = series.streamed ? streamed_statistics(series.streamed) : metrics::statistics(series.errors);
}

Trajectory thinned(Trajectory trajectory, const TrajectoryRequest& request) {
  if (request.downsample > 0) trajectory = downsampled(trajectory, request.downsample);
  if (request.motion_filter)
    trajectory = moved_only(trajectory, request.motion_filter->distance_m, request.motion_filter->angle_rad);
  return trajectory;
}

TrajectoryEvaluation described(const TrajectoryRequest& request, const trajectory_files::TrajectoryPair& pair,
                               const Similarity& alignment) {
  TrajectoryEvaluation result;
  result.request = request;
  result.pairs = pair.size();
  result.possible = pair.possible;
  result.coverage = pair.coverage();
  result.alignment = alignment;
  return result;
}

Result<TrajectoryEvaluation> of_poses(const trajectory_files::TrajectoryPair& pair,
                                      const TrajectoryRequest& request) {
  Result<TrajectoryError> error = absolute_error(
      pair, AbsoluteOptions{request.relation, request.alignment, request.plane, request.keep_poses});
  if (!error) return tl::unexpected(error.error());
  TrajectoryEvaluation result = described(request, pair, error->alignment);
  result.compared = std::move(error->compared);
  result.series.push_back(series_of(std::move(*error)));
  if (!request.fit_offset) return result;
  Result<FittedOffset> fit = fitted_offset(pair);
  if (!fit) return tl::unexpected(fit.error());
  std::vector<std::int64_t> at_ns;
  for (const StampedPose& pose : pair.estimate) at_ns.push_back(pose.timestamp_ns);
  result.series.push_back(series_of("trans_part_offset_fitted", "m", fit->errors_m, std::move(at_ns)));
  result.fitted_offset = std::move(*fit);
  return result;
}

Result<TrajectoryEvaluation> of_motions(const trajectory_files::TrajectoryPair& pair,
                                        const TrajectoryRequest& request) {
  Result<TrajectoryError> error = relative_error(
      pair, RelativeOptions{
                request.relation, request.alignment, request.plane, request.delta,
                request.motions == MotionRule::all ? MotionSelection::all : MotionSelection::consecutive,
                request.delta_tolerance, request.from_reference, request.listing, request.keep_poses});
  if (!error) return tl::unexpected(error.error());
  TrajectoryEvaluation result = described(request, pair, error->alignment);
  result.compared = std::move(error->compared);
  result.series.push_back(series_of(std::move(*error)));
  return result;
}

/// What the scale of TUM's relative error is fitted to: poses as they are paired for its absolute error.
trajectory_files::AssociationOptions paired_for_scale(trajectory_files::AssociationOptions association) {
  constexpr double kLimit_s = 0.02;
  if (std::isinf(association.max_difference_s)) association.max_difference_s = kLimit_s;
  return association;
}

/// TUM's script selects motions from all of the estimate, and then asks for ground truth. A gap longer than
/// twice the delta pairs a pose with itself there, which is no motion and is left out.
Result<TrajectoryEvaluation> of_tum_motions(const Trajectory& reference, Trajectory estimate,
                                            const TrajectoryRequest& request) {
  TrajectoryEvaluation result;
  result.request = request;
  if (request.alignment.mode == AlignmentMode::sim3 || request.alignment.mode == AlignmentMode::scale) {
    const Result<trajectory_files::TrajectoryPair> pair =
        trajectory_files::pair_up(reference, estimate, paired_for_scale(request.association));
    if (!pair) return tl::unexpected(pair.error());
    const Result<Similarity> aligned = align(*pair, request.alignment);
    if (!aligned) return tl::unexpected(aligned.error());
    result.alignment = *aligned;
    for (StampedPose& pose : estimate) pose.T_world_camera.translation *= result.alignment.scale;
  }
  RpeOptions options;
  options.delta = request.delta.value;
  options.unit = request.delta.unit;
  options.all_pairs = request.motions == MotionRule::each_to_each;
  options.max_difference_s = request.association.max_difference_s;
  options.offset_s = request.association.offset_s;
  options.skip_gaps = false;
  options.skip_itself = !options.all_pairs;
  options.listing = request.listing;
  Result<RpeResult> rpe = relative_pose_error(reference, estimate, options);
  if (!rpe) return tl::unexpected(rpe.error());
  result.pairs = rpe->pairs;
  result.possible = rpe->possible;
  result.coverage = rpe->coverage;
  result.with_itself = rpe->with_itself;
  result.request.association.max_difference_s = rpe->max_difference_s;
  if (request.keep_poses) result.compared = {reference, std::move(estimate)};
  result.series.push_back({"trans_part",
                           "m",
                           std::move(rpe->errors_m),
                           rpe->at_ns,
                           {},
                           std::move(rpe->streamed_m),
                           rpe->translation});
  result.series.push_back({"angle_deg",
                           "deg",
                           std::move(rpe->errors_rad),
                           std::move(rpe->at_ns),
                           {},
                           std::move(rpe->streamed_rad),
                           rpe->rotation});
  scale(result.series.back(), kDegreesPerRadian);
  return result;
}

std::vector<double> lengths_m(const Trajectory& reference, Protocol protocol) {
  switch (protocol) {
    case Protocol::kitti:
      return {100, 200, 300, 400, 500, 600, 700, 800};
    case Protocol::eth3d:
      return {0.5, 1, 1.5, 2};
    default:
      return rpg_lengths(reference);
  }
}

IndexPairs segments_of(const Trajectory& reference, Protocol protocol, double length_m) {
  switch (protocol) {
    case Protocol::kitti:
      return kitti_segments(reference, length_m);
    case Protocol::eth3d:
      return eth3d_segments(reference, length_m);
    default:
      return rpg_motions(reference, length_m, true);
  }
}

/// Statistics of value(k) over all segments.
template <typename Value>
metrics::Statistics over(std::size_t segments, Value&& value) {
  std::vector<double> values;
  values.reserve(segments);
  for (std::size_t k = 0; k < segments; ++k) values.push_back(value(k));
  return metrics::statistics(values);
}

/// Errors of segments by their lengths. ETH3D divides by the path of each segment, the others by the length
/// that was requested.
struct RelativeErrors {
  std::vector<double> translation_percent;
  std::vector<double> rotation_deg_per_m;
};
RelativeErrors by_length(const SegmentErrors& errors, Protocol protocol) {
  RelativeErrors relative;
  for (std::size_t k = 0; k < errors.path_m.size(); ++k) {
    const double divisor_m = protocol == Protocol::eth3d ? errors.path_m[k] : errors.length_m;
    relative.translation_percent.push_back(100 * errors.translation_m[k] / divisor_m);
    relative.rotation_deg_per_m.push_back(degrees(errors.rotation_rad[k]) / divisor_m);
  }
  return relative;
}

SegmentRow row_of(const SegmentErrors& errors, const RelativeErrors& relative) {
  const std::size_t n = errors.translation_m.size();
  SegmentRow row;
  row.length_m = errors.length_m;
  row.segments = n;
  row.translation_m = metrics::statistics(errors.translation_m);
  row.translation_percent = metrics::statistics(relative.translation_percent);
  row.rotation_deg = over(n, [&](std::size_t k) { return degrees(errors.rotation_rad[k]); });
  row.rotation_deg_per_m = metrics::statistics(relative.rotation_deg_per_m);
  row.yaw_deg = over(n, [&](std::size_t k) { return degrees(errors.yaw_rad[k]); });
  row.gravity_deg = over(n, [&](std::size_t k) { return degrees(errors.gravity_rad[k]); });
  return row;
}

Result<TrajectoryEvaluation> of_segments(const Trajectory& reference,
                                         const trajectory_files::TrajectoryPair& pair,
                                         const TrajectoryRequest& request) {
  const Result<Similarity> aligned = align(pair, request.alignment);
  if (!aligned) return tl::unexpected(aligned.error());
  TrajectoryEvaluation result = described(request, pair, *aligned);
  if (request.keep_poses) {
    result.compared = {pair.reference, pair.estimate};
    for (StampedPose& pose : result.compared.estimate) pose.T_world_camera = *aligned * pose.T_world_camera;
  }
  std::vector<double> percent;
  std::vector<double> deg_per_m;
  std::vector<std::int64_t> at_ns;
  for (const double length_m : lengths_m(reference, request.protocol)) {
    const IndexPairs segments = segments_of(pair.reference, request.protocol, length_m);
    if (segments.empty()) continue;
    const SegmentErrors errors = segment_errors(pair, segments, length_m, aligned->scale);
    const RelativeErrors relative = by_length(errors, request.protocol);
    result.segments.push_back(row_of(errors, relative));
    percent.insert(percent.end(), relative.translation_percent.begin(), relative.translation_percent.end());
    deg_per_m.insert(deg_per_m.end(), relative.rotation_deg_per_m.begin(), relative.rotation_deg_per_m.end());
    for (const auto& [i, j] : segments) at_ns.push_back(pair.estimate[j].timestamp_ns);
  }
  if (result.segments.empty()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("the reference's path of {:.2f} m has no segment of a length that {} asks for",
                            path_lengths(pair.reference).back(), to_string(request.protocol)),
                "`--protocol evo --delta D --delta_unit m` takes any length");
  }
  result.series.push_back(series_of("translation_percent", "%", std::move(percent), at_ns));
  result.series.push_back(series_of("rotation_deg_per_m", "deg/m", std::move(deg_per_m), std::move(at_ns)));
  return result;
}

std::optional<double> time_coverage(const Trajectory& reference, const Trajectory& estimate,
                                    const trajectory_files::AssociationOptions& association) {
  using trajectory_files::AssociationRule;
  if (association.rule == AssociationRule::index || association.rule == AssociationRule::number)
    return std::nullopt;
  const std::optional<Trajectory> cut = trajectory_files::in_range(reference, association);
  const Trajectory& whole = cut ? *cut : reference;
  if (association.offset_s == 0) return trajectory::covered_share_of_time(whole, estimate);
  return trajectory::covered_share_of_time(
      whole, trajectory::with_clock_offset(estimate, trajectory_files::nanoseconds(association.offset_s)));
}

Result<TrajectoryEvaluation> evaluate_thinned(const Trajectory& reference, const Trajectory& estimate,
                                              const TrajectoryRequest& request) {
  const bool relative = request.metric == TrajectoryMetric::rpe;
  if (relative && (request.motions == MotionRule::fixed_delta || request.motions == MotionRule::each_to_each))
    return of_tum_motions(reference, estimate, request);
  const Result<trajectory_files::TrajectoryPair> pair =
      trajectory_files::pair_up(reference, estimate, request.association);
  if (!pair) return tl::unexpected(pair.error());
  if (!relative) return of_poses(*pair, request);
  if (request.motions == MotionRule::segments) return of_segments(reference, *pair, request);
  return of_motions(*pair, request);
}

}  // namespace

Result<void> change_unit(ErrorSeries& series, const std::string& unit) {
  struct Conversion {
    const char* from;
    const char* to;
    double factor;
  };
  constexpr std::array<Conversion, 5> kConversions{{{"m", "mm", 1e3},
                                                    {"m", "cm", 1e2},
                                                    {"m", "km", 1e-3},
                                                    {"deg", "rad", 1 / kDegreesPerRadian},
                                                    {"rad", "deg", kDegreesPerRadian}}};
  if (series.unit == unit) return {};
  for (const Conversion& conversion : kConversions) {
    if (series.unit != conversion.from || unit != conversion.to) continue;
    scale(series, conversion.factor);
    series.unit = unit;
    return {};
  }
  return fail(ErrorCode::usage,
              fmt::format("--change_unit {}: {} is in {}", unit, series.relation,
                          series.unit.empty() ? "no unit" : series.unit),
              "metres become mm, cm or km, and degrees radians or the other way round");
}

Result<TrajectoryEvaluation> evaluate(const Trajectory& reference, const Trajectory& estimate,
                                      const TrajectoryRequest& request) {
  const bool whole = request.downsample == 0 && !request.motion_filter;
  Result<TrajectoryEvaluation> result =
      whole ? evaluate_thinned(reference, estimate, request)
            : evaluate_thinned(thinned(reference, request), thinned(estimate, request), request);
  if (!result) return result;
  result->reference_poses = reference.size();
  result->estimate_poses = estimate.size();
  result->time_coverage = time_coverage(reference, estimate, request.association);
  return result;
}

}  // namespace fusebench::trajectory_error
