#include "eval/metrics/reference_clock/body_motions.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/base/trajectory/trajectory.hpp"

namespace fusebench::reference_clock {

namespace {

/// Index of the pose whose motion ends nearest to 0.5 s after pose i; nothing if that is not 0.25 to 0.75 s.
std::optional<std::size_t> end_of(const Trajectory& poses, std::size_t i) {
  const std::int64_t wanted_ns = poses[i].timestamp_ns + kMotion_ns;
  const auto after = std::ranges::lower_bound(poses, wanted_ns, {}, &StampedPose::timestamp_ns);
  auto j = static_cast<std::size_t>(after - poses.begin());
  const auto miss_ns = [&](std::size_t at) { return std::abs(poses[at].timestamp_ns - wanted_ns); };
  if (j == poses.size() || miss_ns(j - 1) <= miss_ns(j)) --j;
  return miss_ns(j) <= kMotion_ns / 2 ? std::optional(j) : std::nullopt;
}

/// Index of the latest pose that is 0.1 s or more before pose i; nothing if that is more than 0.6 s.
std::optional<std::size_t> step_back(const Trajectory& poses, std::size_t i) {
  const std::int64_t latest_ns = poses[i].timestamp_ns - kRateStep_ns;
  const auto behind = std::ranges::upper_bound(poses, latest_ns, {}, &StampedPose::timestamp_ns);
  if (behind == poses.begin() || latest_ns - (behind - 1)->timestamp_ns > kMotion_ns) return std::nullopt;
  return static_cast<std::size_t>(behind - poses.begin()) - 1;
}

/// Index of the earliest pose that is 0.1 s or more after pose i; nothing if that is more than 0.6 s.
std::optional<std::size_t> step_forth(const Trajectory& poses, std::size_t i) {
  const std::int64_t earliest_ns = poses[i].timestamp_ns + kRateStep_ns;
  const auto found = std::ranges::lower_bound(poses, earliest_ns, {}, &StampedPose::timestamp_ns);
  if (found == poses.end() || found->timestamp_ns - earliest_ns > kMotion_ns) return std::nullopt;
  return static_cast<std::size_t>(found - poses.begin());
}

/// The motion between two poses; nothing if it is so large that its square would be no number.
std::optional<SE3> motion_between(const SE3& begin, const SE3& end) {
  constexpr double kLargest_m = 1e6;
  const SE3 motion = begin.inverse() * end;
  // Written so that what is not a number is left out.
  return motion.translation.norm() < kLargest_m ? std::optional(motion) : std::nullopt;
}

std::optional<EstimatedMotion> motion_from(const Trajectory& poses, std::size_t i) {
  const auto before = step_back(poses, i);
  const auto after = step_forth(poses, i);
  if (!before || !after) return std::nullopt;
  const auto end = end_of(poses, i);
  const auto end_before = end_of(poses, *before);
  const auto end_after = end_of(poses, *after);
  if (!end || !end_before || !end_after) return std::nullopt;
  const auto between = [&](std::size_t from, std::size_t to) {
    return motion_between(poses[from].T_world_camera, poses[to].T_world_camera);
  };
  const auto motion = between(i, *end);
  const auto earlier = between(*before, *end_before);
  const auto later = between(*after, *end_after);
  if (!motion || !earlier || !later) return std::nullopt;
  return EstimatedMotion{poses[i].timestamp_ns,
                         poses[*end].timestamp_ns,
                         *motion,
                         *earlier,
                         *later,
                         seconds_between(poses[*before].timestamp_ns, poses[*after].timestamp_ns)};
}

}  // namespace

std::vector<EstimatedMotion> estimated_motions(const Trajectory& estimate, std::size_t most) {
  const std::size_t stride = std::max<std::size_t>(1, (estimate.size() + most - 1) / most);
  std::vector<EstimatedMotion> motions;
  for (std::size_t i = 0; i < estimate.size(); i += stride) {
    if (const auto motion = motion_from(estimate, i)) motions.push_back(*motion);
  }
  return motions;
}

std::optional<SE3> reference_motion(const Trajectory& reference, std::int64_t begin_ns, std::int64_t end_ns) {
  const auto begin = trajectory::interpolate_pose(reference, begin_ns, trajectory::kMaxTruthGap_ns);
  if (!begin) return std::nullopt;
  const auto end = trajectory::interpolate_pose(reference, end_ns, trajectory::kMaxTruthGap_ns);
  if (!end) return std::nullopt;
  return motion_between(*begin, *end);
}

std::optional<ReferenceMotion> reference_motion_with_rate(const Trajectory& reference, std::int64_t begin_ns,
                                                          std::int64_t end_ns) {
  const auto motion = reference_motion(reference, begin_ns, end_ns);
  const auto before = reference_motion(reference, begin_ns - kRateStep_ns, end_ns - kRateStep_ns);
  const auto after = reference_motion(reference, begin_ns + kRateStep_ns, end_ns + kRateStep_ns);
  if (!motion || !before || !after) return std::nullopt;
  return ReferenceMotion{*motion, pose_minus(*after, *before) / (2e-9 * static_cast<double>(kRateStep_ns))};
}

}  // namespace fusebench::reference_clock
