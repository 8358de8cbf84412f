// Speeds, and the blur that they make.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/geometry.hpp"
#include "core/trajectory/trajectory.hpp"
#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/order_statistics.hpp"

namespace fusebench::inspection {

namespace {

/// From the frame before to the one after: over one interval the jitter of a motion-capture system shows.
std::vector<SpeedSample> speeds_from_truth(const recording::Recording& recording) {
  const std::int64_t gap_ns = truth_gap_ns(recording);
  std::vector<std::optional<SE3>> poses;
  for (const recording::FrameEntry& frame : recording.frames)
    poses.push_back(trajectory::interpolate_pose(recording.ground_truth, frame.capture_ns, gap_ns));
  std::vector<SpeedSample> result;
  const std::size_t count = poses.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t before = k == 0 ? 0 : k - 1;
    const std::size_t after = std::min(k + 1, count - 1);
    const double dt_s =
        seconds_between(recording.frames[before].capture_ns, recording.frames[after].capture_ns);
    if (!poses[before] || !poses[after] || dt_s <= 0 || dt_s > 0.5) continue;
    SpeedSample sample;
    sample.frame = k;
    sample.angular_radps = rotation_angle_rad(poses[before]->rotation, poses[after]->rotation) / dt_s;
    sample.linear_mps = (poses[after]->translation - poses[before]->translation).norm() / dt_s;
    result.push_back(sample);
  }
  return result;
}

/// Mean of the gyroscope from the frame before to the one after, its bias at rest taken away.
std::vector<SpeedSample> speeds_from_gyroscope(const recording::Recording& recording,
                                               const Vector3d& bias_radps) {
  std::vector<SpeedSample> result;
  const auto& frames = recording.frames;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::int64_t begin_ns = frames[k == 0 ? 0 : k - 1].capture_ns;
    const std::int64_t end_ns = frames[std::min(k + 1, frames.size() - 1)].capture_ns;
    const auto first = std::ranges::lower_bound(recording.imu, begin_ns, {}, &ImuSample::timestamp_ns);
    Vector3d sum = Vector3d::Zero();
    int samples = 0;
    for (auto sample = first; sample != recording.imu.end() && sample->timestamp_ns <= end_ns;
         ++sample, ++samples)
      sum += sample->angular_velocity_radps;
    if (samples == 0) continue;
    result.push_back({k, 0, (sum / samples - bias_radps).norm(), std::nullopt, 0});
  }
  return result;
}

void report_jumps(const MotionMeasurement& motion, Inspection& out) {
  const auto fastest = std::ranges::max_element(
      motion.speeds, {}, [](const SpeedSample& s) { return s.linear_mps.value_or(0); });
  const auto fastest_turn = std::ranges::max_element(motion.speeds, {}, &SpeedSample::angular_radps);
  const bool jumps = *motion.linear_max_mps > 8 || motion.angular_max_radps > 20;
  if (!jumps) return;
  out.add("truth-jump", Severity::warning,
          fmt::format("the ground truth moves with up to {:.1f} m/s (frame {}) and {:.0f} deg/s (frame {}), "
                      "which no hand does",
                      *motion.linear_max_mps, fastest->frame, kDegreesPerRadian * motion.angular_max_radps,
                      fastest_turn->frame),
          "leave the poses around it out, or look whether its stamps are right");
}

void summarise(Inspection& out) {
  MotionMeasurement& motion = out.motion;
  std::vector<double> angular, linear, blur;
  for (const SpeedSample& sample : motion.speeds) {
    angular.push_back(sample.angular_radps);
    blur.push_back(sample.blur_px);
    if (sample.linear_mps) linear.push_back(*sample.linear_mps);
    motion.angular_mean_radps += sample.angular_radps / static_cast<double>(motion.speeds.size());
    motion.severe_share +=
        (sample.blur_px >= kSevereBlur_px ? 1.0 : 0.0) / static_cast<double>(motion.speeds.size());
  }
  motion.angular_p95_radps = measures::quantile(angular, 0.95);
  motion.angular_max_radps = *std::ranges::max_element(angular);
  motion.blur_median_px = measures::median(blur);
  motion.blur_p95_px = measures::quantile(std::move(blur), 0.95);
  motion.fast = motion.severe_share >= kFastShare;
  if (linear.empty()) return;
  double sum_mps = 0;
  for (const double speed : linear) sum_mps += speed;
  motion.linear_mean_mps = sum_mps / static_cast<double>(linear.size());
  motion.linear_max_mps = *std::ranges::max_element(linear);
  motion.linear_p95_mps = measures::quantile(std::move(linear), 0.95);
}

double path_length_m(const recording::Recording& recording) {
  const std::int64_t gap_ns = truth_gap_ns(recording);
  double path_m = 0;
  std::optional<SE3> last;
  for (const recording::FrameEntry& frame : recording.frames) {
    const auto pose = trajectory::interpolate_pose(recording.ground_truth, frame.capture_ns, gap_ns);
    if (!pose) continue;
    if (last) path_m += (pose->translation - last->translation).norm();
    last = pose;
  }
  return path_m;
}

}  // namespace

void check_motion(const recording::Recording& recording, Inspection& out) {
  if (!times_are_plausible(out) || recording.frames.size() < 3) return;
  MotionMeasurement& motion = out.motion;
  if (out.truth && !out.has("truth-out-of-order")) {
    motion.speeds = speeds_from_truth(recording);
    motion.source = "ground truth";
    out.truth->path_m = path_length_m(recording);
  }
  if (motion.speeds.empty() && out.imu && !out.has("imu-out-of-order")) {
    motion.speeds =
        speeds_from_gyroscope(recording, out.imu->gyroscope_bias_radps.value_or(Vector3d::Zero()));
    motion.source = "gyroscope";
  }
  if (motion.speeds.empty()) {
    motion.source.clear();
    return;
  }
  const double depth_m = out.depth.median_m > 0 ? out.depth.median_m : 2.0;
  for (SpeedSample& sample : motion.speeds) {
    sample.time_s =
        seconds_between(recording.frames.front().timestamp_ns, recording.frames[sample.frame].timestamp_ns);
    sample.blur_px = kBlurExposure_s * std::abs(recording.rig.camera.fx_px) *
                     (sample.angular_radps + sample.linear_mps.value_or(0) / depth_m);
  }
  summarise(out);
  out.add(motion.fast ? "motion-fast" : "motion-slow", Severity::note,
          fmt::format("{} motion, by the {}: {:.0f} % of frames would be blurred by at least {:.0f} px in a "
                      "10 ms exposure "
                      "(fast from {:.0f} %)",
                      motion.fast ? "fast" : "slow", motion.source, 100 * motion.severe_share, kSevereBlur_px,
                      100 * kFastShare));
  if (motion.linear_max_mps) report_jumps(motion, out);
}

}  // namespace fusebench::inspection
