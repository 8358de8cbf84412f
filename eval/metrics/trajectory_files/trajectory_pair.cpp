#include "eval/metrics/trajectory_files/trajectory_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/trajectory/association.hpp"
#include "core/base/trajectory/trajectory.hpp"
#include "eval/metrics/trajectory_files/nearest_association.hpp"
#include "eval/metrics/trajectory_files/stamps.hpp"

namespace fusebench::trajectory_files {

namespace {

void take(const Trajectory& reference, const Trajectory& estimate,
          std::span<const trajectory::AssociatedPair> pairs, TrajectoryPair& result) {
  result.reference.reserve(pairs.size());
  result.estimate.reserve(pairs.size());
  for (const trajectory::AssociatedPair& pair : pairs) {
    result.reference.push_back(reference[pair.first]);
    result.estimate.push_back(estimate[pair.second]);
  }
  result.possible = std::min(reference.size(), estimate.size());
}

void interpolate_reference(const Trajectory& reference, const Trajectory& estimate, TrajectoryPair& result) {
  const std::int64_t offset_ns = nanoseconds(result.options.offset_s);
  const std::int64_t gap_ns = nanoseconds(result.options.max_difference_s);
  for (const StampedPose& pose : estimate) {
    const std::int64_t wanted_ns = clamped_sum(pose.timestamp_ns, offset_ns);
    const std::optional<SE3> truth = trajectory::interpolate_pose(reference, wanted_ns, gap_ns);
    if (!truth) continue;
    result.reference.push_back({wanted_ns, *truth});
    result.estimate.push_back(pose);
  }
  result.possible = estimate.size();
}

/// The reference at the stamps that are evaluated, as far as it is known there. As ETH3D's program has it, a
/// stamp that just meets the last pose of the reference is not.
Trajectory at_stamps(const Trajectory& reference, const AssociationOptions& options) {
  Trajectory poses;
  for (const std::int64_t stamp_ns : options.evaluated_ns) {
    if (stamp_ns >= reference.back().timestamp_ns) break;
    const auto pose =
        trajectory::interpolate_pose(reference, stamp_ns, nanoseconds(options.max_difference_s));
    if (pose) poses.push_back({stamp_ns, *pose});
  }
  return poses;
}

/// A lost tracker is charged for the poses that it did not give.
void hold_estimate(const Trajectory& own_reference, const Trajectory& estimate, TrajectoryPair& result) {
  const Trajectory interpolated = at_stamps(own_reference, result.options);
  const Trajectory& reference = result.options.evaluated_ns.empty() ? own_reference : interpolated;
  const std::int64_t offset_ns = nanoseconds(result.options.offset_s);
  for (const StampedPose& truth : reference) {
    const std::int64_t wanted_ns = clamped_sum(truth.timestamp_ns, -offset_ns);
    const auto clamped = std::clamp(wanted_ns, estimate.front().timestamp_ns, estimate.back().timestamp_ns);
    const std::optional<SE3> pose =
        trajectory::interpolate_pose(estimate, clamped, std::numeric_limits<std::int64_t>::max());
    result.reference.push_back(truth);
    result.estimate.push_back({wanted_ns, *pose});
  }
  result.possible = reference.size();
}

}  // namespace

std::string_view to_string(AssociationRule rule) {
  switch (rule) {
    case AssociationRule::nearest:
      return "nearest";
    case AssociationRule::greedy:
      return "greedy";
    case AssociationRule::index:
      return "index";
    case AssociationRule::number:
      return "number";
    case AssociationRule::interpolated:
      return "interpolated";
    case AssociationRule::held:
      return "held";
  }
  return "";
}

std::optional<Trajectory> in_range(const Trajectory& reference, const AssociationOptions& options) {
  if (std::isinf(options.start_s) && std::isinf(options.end_s)) return std::nullopt;
  Trajectory kept;
  for (const StampedPose& pose : reference) {
    const double time_s = stamp_seconds(pose.timestamp_ns);
    if (time_s >= options.start_s && time_s <= options.end_s) kept.push_back(pose);
  }
  return kept;
}

Result<TrajectoryPair> pair_up(const Trajectory& reference_whole, const Trajectory& estimate,
                               const AssociationOptions& options) {
  const std::optional<Trajectory> cut = in_range(reference_whole, options);
  const Trajectory& reference = cut ? *cut : reference_whole;
  if (reference.empty() || estimate.empty()) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format(
            "nothing to compare: {} of {} poses of the reference are within the time range, {} of the "
            "estimate",
            reference.size(), reference_whole.size(), estimate.size()));
  }
  TrajectoryPair result;
  result.options = options;
  switch (options.rule) {
    case AssociationRule::nearest:
      take(reference, estimate,
           associate_nearest(stamps_of(reference), stamps_of(estimate), options.max_difference_s,
                             options.offset_s),
           result);
      break;
    case AssociationRule::greedy:
      take(reference, estimate,
           trajectory::associate(stamps_of(reference), stamps_of(estimate),
                                 nanoseconds(options.max_difference_s), nanoseconds(options.offset_s)),
           result);
      break;
    case AssociationRule::index:
      if (reference.size() != estimate.size()) {
        return fail(
            ErrorCode::data_corrupt,
            fmt::format("poses without stamps go by number, but the reference has {} and the estimate {}",
                        reference.size(), estimate.size()),
            "use trajectories with stamps, or fill what is missing");
      }
      result.reference = reference;
      result.estimate = estimate;
      result.possible = reference.size();
      break;
    case AssociationRule::number:
      take(reference, estimate, trajectory::associate(stamps_of(reference), stamps_of(estimate), 1, 0),
           result);
      break;
    case AssociationRule::interpolated:
      interpolate_reference(reference, estimate, result);
      break;
    case AssociationRule::held:
      hold_estimate(reference, estimate, result);
      break;
  }
  if (result.size() == 0 && options.rule == AssociationRule::number) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("no pose of the estimate (frames {} to {}) has the number of one of the reference "
                    "(frames {} to {})",
                    estimate.front().timestamp_ns, estimate.back().timestamp_ns,
                    reference.front().timestamp_ns, reference.back().timestamp_ns));
  }
  if (result.size() == 0) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format(
            "no stamps of the estimate ({} poses, {:.3f} to {:.3f} s) and the reference ({} poses, {:.3f} to "
            "{:.3f} s) match within {} s",
            estimate.size(), stamp_seconds(estimate.front().timestamp_ns),
            stamp_seconds(estimate.back().timestamp_ns), reference.size(),
            stamp_seconds(reference.front().timestamp_ns), stamp_seconds(reference.back().timestamp_ns),
            options.max_difference_s),
        "do both use the same clock and unit? --t_offset is added to the estimate's stamps, --t_max_diff is "
        "the limit, --stamp_unit REF,EST gives the units, such as s,ns");
  }
  return result;
}

}  // namespace fusebench::trajectory_files
