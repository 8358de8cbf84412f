#include "eval/metrics/trajectory_error/ate_rpe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>

#include "core/base/trajectory/association.hpp"
#include "eval/metrics/trajectory_error/alignment.hpp"
#include "eval/metrics/trajectory_error/pose_relation.hpp"
#include "eval/metrics/trajectory_files/stamps.hpp"

namespace fusebench::trajectory_error {

namespace {

constexpr double kGapFactor = 1.5;

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::vector<trajectory::AssociatedPair> associate(const Trajectory& ground_truth,
                                                  std::span<const std::int64_t> stamps_ns,
                                                  const AteOptions& options) {
  return trajectory::associate(trajectory_files::stamps_of(ground_truth), stamps_ns,
                               trajectory_files::nanoseconds(options.max_difference_s),
                               trajectory_files::nanoseconds(options.offset_s));
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
  return metrics::statistics(intervals).median;
}

bool skips_itself(const RpeOptions& options) { return options.skip_gaps || options.skip_itself; }

/// The motions of the estimate that are compared. with_itself: how many pairs of a pose with itself are left
/// out.
IndexPairs motions_of(const Trajectory& estimate, std::span<const std::int64_t> stamps,
                      const RpeOptions& options, std::size_t& with_itself) {
  IndexPairs motions =
      options.all_pairs ? all_to_all(estimate.size()) : tum_motions(estimate, {options.delta, options.unit});
  if (!skips_itself(options)) return motions;
  with_itself = std::erase_if(motions, [](const auto& motion) { return motion.first == motion.second; });
  if (!options.skip_gaps || options.all_pairs || options.unit != DeltaUnit::frames) return motions;
  const double gap_limit_ns = kGapFactor * options.delta * median_interval(stamps);
  std::erase_if(motions, [&](const auto& motion) {
    return static_cast<double>(stamps[motion.second] - stamps[motion.first]) > gap_limit_ns;
  });
  return motions;
}

Result<void> check_rpe_input(const Trajectory& ground_truth, const Trajectory& estimate,
                             const RpeOptions& options) {
  if (auto sensible = check_delta({options.delta, options.unit}); !sensible) return sensible;
  if (options.delta <= 0)
    return fail(ErrorCode::configuration, fmt::format("delta = {} (allowed: above 0)", options.delta));
  if (ground_truth.size() < 2 || estimate.size() < 2) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("a relative pose error needs two poses on either side (ground truth {}, estimate {})",
                    ground_truth.size(), estimate.size()));
  }
  return {};
}

/// An estimate, and the ground truth nearest in time to each of its poses.
struct MatchedPoses {
  std::vector<SE3> estimate;
  std::vector<std::optional<SE3>> truth;
  double limit_ns = 0;
};

MatchedPoses match(const Trajectory& ground_truth, const Trajectory& estimate, const RpeOptions& options) {
  const std::vector<std::int64_t> truth_ns = trajectory_files::stamps_of(ground_truth);
  const std::int64_t offset = trajectory_files::nanoseconds(options.offset_s);
  MatchedPoses poses;
  poses.limit_ns = std::min(2 * median_interval(truth_ns), options.max_difference_s * 1e9);
  for (const StampedPose& pose : estimate) {
    const std::int64_t wanted = trajectory_files::clamped_sum(pose.timestamp_ns, offset);
    const std::size_t nearest = nearest_stamp(truth_ns, wanted);
    const bool near =
        static_cast<double>(std::abs(trajectory_files::clamped_sum(truth_ns[nearest], -wanted))) <=
        poses.limit_ns;
    poses.estimate.push_back(pose.T_world_camera);
    poses.truth.push_back(near ? std::optional(ground_truth[nearest].T_world_camera) : std::nullopt);
  }
  return poses;
}

/// (P_j^-1 P_i)^-1 (G_j^-1 G_i); both have ground truth.
SE3 motion_error(const MatchedPoses& poses, std::size_t i, std::size_t j) {
  return motion_between(motion_between(poses.estimate[j], poses.estimate[i]),
                        motion_between(*poses.truth[j], *poses.truth[i]));
}

void list_errors(const MatchedPoses& poses, const IndexPairs& motions,
                 std::span<const std::int64_t> estimate_ns, RpeResult& result) {
  result.possible = motions.size();
  result.errors_m.reserve(motions.size());
  result.errors_rad.reserve(motions.size());
  result.at_ns.reserve(motions.size());
  for (const auto& [i, j] : motions) {
    if (!poses.truth[i] || !poses.truth[j]) continue;
    const SE3 error = motion_error(poses, i, j);
    result.errors_m.push_back(error.translation.norm());
    result.errors_rad.push_back(so3_log(error.rotation).norm());
    result.at_ns.push_back(estimate_ns[j]);
  }
  result.pairs = result.errors_m.size();
  result.translation = metrics::statistics(result.errors_m);
  result.rotation = metrics::statistics(result.errors_rad);
}

/// Errors of every pose with every pose that have ground truth, in the order of all_to_all().
template <typename ErrorOf>
ValueSource each_to_each(std::shared_ptr<const MatchedPoses> poses, bool with_itself, ErrorOf error_of) {
  return [poses = std::move(poses), with_itself, error_of](const ValueVisitor& visit) {
    for (std::size_t i = 0; i < poses->estimate.size(); ++i) {
      for (std::size_t j = 0; poses->truth[i] && j < poses->estimate.size(); ++j) {
        if (poses->truth[j] && (with_itself || i != j)) visit(error_of(motion_error(*poses, i, j)));
      }
    }
  };
}

void stream_errors(MatchedPoses matched, bool with_itself, RpeResult& result) {
  const std::size_t count = matched.estimate.size();
  const auto poses = std::make_shared<const MatchedPoses>(std::move(matched));
  result.possible = count * count - (with_itself ? 0 : count);
  result.streamed_m =
      each_to_each(poses, with_itself, [](const SE3& error) { return error.translation.norm(); });
  result.streamed_rad =
      each_to_each(poses, with_itself, [](const SE3& error) { return so3_log(error.rotation).norm(); });
  result.translation = streamed_statistics(result.streamed_m);
  result.rotation = streamed_statistics(result.streamed_rad);
  result.pairs = result.translation.count;
}

}  // namespace

std::array<double, 16> matrix_of(const SE3& transform) {
  const Matrix3d r = transform.rotation_matrix();
  const Vector3d& t = transform.translation;
  return {r(0, 0), r(0, 1), r(0, 2), t.x(), r(1, 0), r(1, 1), r(1, 2), t.y(),
          r(2, 0), r(2, 1), r(2, 2), t.z(), 0,       0,       0,       1};
}

Result<std::vector<trajectory::AssociatedPair>> associated_poses(const Trajectory& ground_truth,
                                                                 const Trajectory& estimate,
                                                                 const AteOptions& options) {
  std::vector<trajectory::AssociatedPair> pairs =
      associate(ground_truth, trajectory_files::stamps_of(estimate), options);
  if (!pairs.empty()) return pairs;
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("no stamps of the estimate ({} poses) and the ground truth ({} poses) match within {} s",
                  estimate.size(), ground_truth.size(), options.max_difference_s),
      "do both use the same clock?");
}

Result<AteResult> absolute_trajectory_error(const Trajectory& ground_truth, const Trajectory& estimate,
                                            const AteOptions& options) {
  const auto associated = associated_poses(ground_truth, estimate, options);
  if (!associated) return tl::unexpected(associated.error());
  const std::vector<trajectory::AssociatedPair>& pairs = *associated;
  AteResult result;
  result.max_difference_s = options.max_difference_s;
  result.pairs = pairs.size();
  result.possible = options.expected_ns.empty()
                        ? estimate.size()
                        : associate(ground_truth, options.expected_ns, options).size();
  result.coverage = share(result.pairs, result.possible);

  std::vector<Vector3d> truth_positions;
  std::vector<Vector3d> estimate_positions;
  for (const trajectory::AssociatedPair& pair : pairs) {
    truth_positions.push_back(ground_truth[pair.first].T_world_camera.translation);
    estimate_positions.push_back(estimate[pair.second].T_world_camera.translation);
  }
  const auto aligned = align_positions(truth_positions, estimate_positions, false);
  if (!aligned) return tl::unexpected(aligned.error());
  result.alignment = {"se3", aligned->rigid};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Vector3d truth = truth_positions[i] - aligned->image;
    result.errors_m.push_back((aligned->from_image(estimate_positions[i]) - truth).norm());
  }
  result.stats = metrics::statistics(result.errors_m);
  return result;
}

Result<RpeResult> relative_pose_error(const Trajectory& ground_truth, const Trajectory& estimate,
                                      const RpeOptions& options) {
  if (auto usable = check_rpe_input(ground_truth, estimate, options); !usable)
    return tl::unexpected(usable.error());
  MatchedPoses poses = match(ground_truth, estimate, options);
  RpeResult result;
  result.delta = options.delta;
  result.unit = options.unit;
  result.max_difference_s = poses.limit_ns * 1e-9;
  if (options.all_pairs && estimate.size() > options.listing.most / estimate.size()) {
    const std::size_t motions = estimate.size() * estimate.size();
    if (auto usual = check_compared(options.listing, motions); !usual) return tl::unexpected(usual.error());
    if (auto listed = check_listing(options.listing, motions); !listed) return tl::unexpected(listed.error());
    stream_errors(std::move(poses), !skips_itself(options), result);
  } else {
    const std::vector<std::int64_t> estimate_ns = trajectory_files::stamps_of(estimate);
    list_errors(poses, motions_of(estimate, estimate_ns, options, result.with_itself), estimate_ns, result);
  }
  result.coverage = share(result.pairs, result.possible);
  if (result.pairs < 2) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("only {} of {} pairs over {} {} have ground truth within {} s (two are needed)",
                            result.pairs, result.possible, options.delta, to_string(options.unit),
                            result.max_difference_s),
                "is the trajectory shorter than delta, or is its clock another?");
  }
  return result;
}

}  // namespace fusebench::trajectory_error
