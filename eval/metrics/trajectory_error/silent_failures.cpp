#include "eval/metrics/trajectory_error/silent_failures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/trajectory/trajectory.hpp"
#include "eval/metrics/trajectory_error/pose_relation.hpp"
#include "eval/metrics/trajectory_files/stamps.hpp"

namespace fusebench::trajectory_error {

namespace {

/// A claimed pose and the true one at its instant.
struct KnownPose {
  std::int64_t timestamp_ns = 0;
  SE3 estimate;
  SE3 truth;
};

std::vector<KnownPose> known_poses(const Trajectory& ground_truth, const Trajectory& estimate) {
  std::vector<KnownPose> known;
  for (const StampedPose& pose : estimate) {
    const auto truth =
        trajectory::interpolate_pose(ground_truth, pose.timestamp_ns, trajectory::kMaxTruthGap_ns);
    if (truth) known.push_back({pose.timestamp_ns, pose.T_world_camera, *truth});
  }
  return known;
}

}  // namespace

std::vector<JudgedPose> judged_poses(const Trajectory& ground_truth, const Trajectory& estimate,
                                     const SilentFailureLimits& limits) {
  const std::vector<KnownPose> known = known_poses(ground_truth, estimate);
  const auto interval_ns = trajectory_files::nanoseconds(limits.interval_s);
  std::vector<JudgedPose> judged;
  std::size_t before = 0;
  for (std::size_t now = 1; now < known.size(); ++now) {
    while (before + 1 < now && known[before + 1].timestamp_ns + interval_ns <= known[now].timestamp_ns)
      ++before;
    const SE3 claimed = motion_between(known[before].estimate, known[now].estimate);
    const SE3 real = motion_between(known[before].truth, known[now].truth);
    const SE3 error = real.inverse() * claimed;
    JudgedPose pose{known[now].timestamp_ns, error.translation.norm(),
                    rotation_angle_rad(real.rotation, claimed.rotation), false};
    // Written so that a pose that is not a number is a failure.
    pose.silent =
        !(pose.translation_m <= limits.max_translation_m && pose.rotation_rad <= limits.max_rotation_rad);
    judged.push_back(pose);
  }
  return judged;
}

Result<SilentFailures> silent_failures(const Trajectory& ground_truth, const Trajectory& estimate,
                                       const SilentFailureLimits& limits) {
  const std::vector<JudgedPose> judged = judged_poses(ground_truth, estimate, limits);
  if (judged.empty())
    return fail(ErrorCode::data_corrupt, "fewer than two poses of the estimate have ground truth");
  SilentFailures result;
  result.limits = limits;
  result.judged = judged.size();
  for (const JudgedPose& pose : judged) {
    result.worst_translation_m = std::max(result.worst_translation_m, pose.translation_m);
    result.worst_rotation_rad = std::max(result.worst_rotation_rad, pose.rotation_rad);
    if (!pose.silent) continue;
    ++result.silent;
    if (!result.first_ns) result.first_ns = pose.timestamp_ns;
  }
  return result;
}

}  // namespace fusebench::trajectory_error
