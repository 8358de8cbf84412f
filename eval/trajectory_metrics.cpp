#include "eval/trajectory_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/association.hpp"
#include "eval/trajectory/alignment.hpp"
#include "eval/trajectory/stamps.hpp"

namespace fusebench {

namespace {

constexpr double kGapFactor = 1.5;
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

/// Index of the stamp nearest to `wanted` in a sorted, non-empty list; the earlier of two at the same
/// distance.
std::size_t nearest_stamp(std::span<const std::int64_t> stamps, std::int64_t wanted) {
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), wanted);
  if (after == stamps.begin()) return 0;
  const auto index = static_cast<std::size_t>(after - stamps.begin());
  if (after == stamps.end() || wanted - *(after - 1) <= *after - wanted) return index - 1;
  return index;
}

/// Median interval in nanoseconds; at least two stamps.
double median_interval(std::span<const std::int64_t> stamps) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i)
    intervals.push_back(static_cast<double>(stamps[i] - stamps[i - 1]));
  return statistics(intervals).median;
}

/// The partner of each pose i under the fixed delta; kNone if it has none.
std::vector<std::size_t> partners(std::span<const std::int64_t> stamps, const RpeOptions& options) {
  const std::size_t last = stamps.size() - 1;
  std::vector<std::size_t> result(stamps.size(), kNone);
  const double gap_limit = kGapFactor * options.delta * median_interval(stamps);
  for (std::size_t i = 0; i <= last; ++i) {
    std::size_t j = kNone;
    if (options.unit == DeltaUnit::seconds) {
      j = nearest_stamp(stamps, stamps[i] + nanoseconds(options.delta));
      if (options.skip_gaps && j == i) continue;
    } else {
      j = std::min(last, i + static_cast<std::size_t>(options.delta));
      if (options.skip_gaps && static_cast<double>(stamps[j] - stamps[i]) > gap_limit) continue;
    }
    if (j != last) result[i] = j;
  }
  return result;
}

Result<void> check_rpe_input(const Trajectory& ground_truth, const Trajectory& estimate,
                             const RpeOptions& options) {
  const bool known = options.unit == DeltaUnit::frames || options.unit == DeltaUnit::seconds;
  const bool whole = options.unit != DeltaUnit::frames || std::floor(options.delta) == options.delta;
  if (!known || !whole || !(options.delta > 0 && std::isfinite(options.delta))) {
    return fail(ErrorCode::configuration,
                fmt::format("delta = {} {} (allowed: positive seconds, or a whole number of frames)",
                            options.delta, to_string(options.unit)));
  }
  if (ground_truth.size() < 2 || estimate.size() < 2) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("a relative pose error needs two poses on either side (ground truth {}, estimate {})",
                    ground_truth.size(), estimate.size()));
  }
  return {};
}

}  // namespace

std::array<double, 16> matrix_of(const SE3& transform) {
  const Matrix3d r = transform.rotation_matrix();
  const Vector3d& t = transform.translation;
  return {r(0, 0), r(0, 1), r(0, 2), t.x(), r(1, 0), r(1, 1), r(1, 2), t.y(),
          r(2, 0), r(2, 1), r(2, 2), t.z(), 0,       0,       0,       1};
}

Result<AteResult> absolute_trajectory_error(const Trajectory& ground_truth, const Trajectory& estimate,
                                            const AteOptions& options) {
  const std::vector<std::int64_t> truth_ns = stamps_of(ground_truth);
  const std::vector<std::int64_t> estimate_ns = stamps_of(estimate);
  const std::int64_t limit = nanoseconds(options.max_difference_s);
  const std::int64_t offset = nanoseconds(options.offset_s);
  const std::vector<AssociatedPair> pairs = associate(truth_ns, estimate_ns, limit, offset);

  AteResult result;
  result.max_difference_s = options.max_difference_s;
  result.pairs = pairs.size();
  result.possible = options.expected_ns.empty()
                        ? estimate.size()
                        : associate(truth_ns, options.expected_ns, limit, offset).size();
  result.coverage = share(result.pairs, result.possible);
  if (pairs.empty()) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("no stamps of the estimate ({} poses) and the ground truth ({} poses) match within {} s",
                    estimate.size(), ground_truth.size(), options.max_difference_s),
        "do both use the same clock?");
  }

  std::vector<Vector3d> truth_positions;
  std::vector<Vector3d> estimate_positions;
  for (const AssociatedPair& pair : pairs) {
    truth_positions.push_back(ground_truth[pair.first].T_world_camera.translation);
    estimate_positions.push_back(estimate[pair.second].T_world_camera.translation);
  }
  const auto aligned = align_positions(truth_positions, estimate_positions, false);
  if (!aligned) return tl::unexpected(aligned.error());
  result.alignment = {"se3", aligned->rigid};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    result.errors_m.push_back((aligned->rigid * estimate_positions[i] - truth_positions[i]).norm());
  }
  result.stats = statistics(result.errors_m);
  return result;
}

Result<RpeResult> relative_pose_error(const Trajectory& ground_truth, const Trajectory& estimate,
                                      const RpeOptions& options) {
  if (auto usable = check_rpe_input(ground_truth, estimate, options); !usable)
    return tl::unexpected(usable.error());
  const std::vector<std::int64_t> truth_ns = stamps_of(ground_truth);
  const std::vector<std::int64_t> estimate_ns = stamps_of(estimate);
  const std::int64_t offset = nanoseconds(options.offset_s);
  const double limit_ns = std::min(2 * median_interval(truth_ns), options.max_difference_s * 1e9);

  const auto truth_at = [&](std::size_t i) -> std::optional<std::size_t> {
    const std::int64_t wanted = estimate_ns[i] + offset;
    const std::size_t nearest = nearest_stamp(truth_ns, wanted);
    if (static_cast<double>(std::abs(truth_ns[nearest] - wanted)) > limit_ns) return std::nullopt;
    return nearest;
  };

  RpeResult result;
  result.delta = options.delta;
  result.unit = options.unit;
  result.max_difference_s = limit_ns * 1e-9;
  const std::vector<std::size_t> partner = partners(estimate_ns, options);
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i] == kNone) continue;
    const std::size_t j = partner[i];
    ++result.possible;
    const auto truth_i = truth_at(i);
    const auto truth_j = truth_at(j);
    if (!truth_i || !truth_j) continue;
    const SE3 estimate_motion = estimate[j].T_world_camera.inverse() * estimate[i].T_world_camera;
    const SE3 truth_motion =
        ground_truth[*truth_j].T_world_camera.inverse() * ground_truth[*truth_i].T_world_camera;
    const SE3 error = estimate_motion.inverse() * truth_motion;
    result.errors_m.push_back(error.translation.norm());
    result.errors_rad.push_back(so3_log(error.rotation).norm());
  }
  result.pairs = result.errors_m.size();
  result.coverage = share(result.pairs, result.possible);
  if (result.pairs < 2) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("only {} of {} pairs over {} {} have ground truth within {} s (two are needed)",
                            result.pairs, result.possible, options.delta, to_string(options.unit),
                            result.max_difference_s),
                "is the trajectory shorter than delta, or is its clock another?");
  }
  result.translation = statistics(result.errors_m);
  result.rotation = statistics(result.errors_rad);
  return result;
}

}  // namespace fusebench
