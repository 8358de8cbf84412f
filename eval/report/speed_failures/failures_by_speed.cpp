#include "eval/report/speed_failures/failures_by_speed.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/geometry.hpp"
#include "core/base/trajectory/trajectory.hpp"

namespace fusebench::speed_failures {

namespace {

constexpr std::int64_t kMean_ns = 100'000'000;

/// Mean angular speed until each of the stamps; nothing where the ground truth is unknown.
std::vector<std::optional<double>> speeds_degps(const Trajectory& truth,
                                                std::span<const std::int64_t> stamps_ns) {
  std::vector<std::optional<double>> speeds(stamps_ns.size());
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    const auto before =
        trajectory::interpolate_pose(truth, stamps_ns[i] - kMean_ns, trajectory::kMaxTruthGap_ns);
    const auto now = trajectory::interpolate_pose(truth, stamps_ns[i], trajectory::kMaxTruthGap_ns);
    if (before && now)
      speeds[i] = degrees(rotation_angle_rad(before->rotation, now->rotation)) / (1e-9 * kMean_ns);
  }
  return speeds;
}

}  // namespace

SpeedBin& SpeedBin::operator+=(const SpeedBin& other) {
  frames += other.frames;
  lost += other.lost;
  silent += other.silent;
  return *this;
}

std::vector<SpeedBin> failures_by_speed(const Trajectory& ground_truth,
                                        std::span<const std::int64_t> frames_ns, const Trajectory& estimate,
                                        const trajectory_error::SilentFailureLimits& limits) {
  const std::vector<trajectory_error::JudgedPose> judged =
      trajectory_error::judged_poses(ground_truth, estimate, limits);
  const std::vector<std::optional<double>> speeds = speeds_degps(ground_truth, frames_ns);
  const auto interval_ns = static_cast<std::int64_t>(std::llround(1e9 * limits.interval_s));
  std::vector<SpeedBin> bins;
  std::size_t earliest = 0;
  for (std::size_t i = 0; i < frames_ns.size(); ++i) {
    while (frames_ns[earliest] + interval_ns < frames_ns[i]) ++earliest;
    std::optional<double> fastest;
    for (std::size_t k = earliest; k <= i; ++k) {
      if (speeds[k]) fastest = std::max(fastest.value_or(0), *speeds[k]);
    }
    if (!fastest) continue;
    const auto pose =
        std::ranges::lower_bound(judged, frames_ns[i], {}, &trajectory_error::JudgedPose::timestamp_ns);
    const bool is_judged = pose != judged.end() && pose->timestamp_ns == frames_ns[i];
    const bool has_pose = std::ranges::binary_search(estimate, frames_ns[i], {}, &StampedPose::timestamp_ns);
    if (has_pose && !is_judged) continue;
    const auto bin = static_cast<std::size_t>(*fastest / kSpeedBin_degps);
    if (bin >= bins.size()) bins.resize(bin + 1);
    bins[bin] += {1, has_pose ? 0U : 1U, is_judged && pose->silent ? 1U : 0U};
  }
  return bins;
}

}  // namespace fusebench::speed_failures
