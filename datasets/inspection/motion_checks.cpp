// Speeds, and the blur that they make; a ground truth that stands still while the images move.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/trajectory/trajectory.hpp"
#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/camera_turns.hpp"
#include "datasets/inspection/measures/order_statistics.hpp"
#include "datasets/inspection/warp_pairs.hpp"

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

namespace {

constexpr std::size_t kStillPairs = 24;
constexpr std::size_t kMinStillPairs = 3;
constexpr double kStillApart_s = 0.3;
constexpr double kTruthStill_rad = radians(0.3);
// More than three times what a ground truth that stands still may move by.
constexpr double kImagesMove_rad = radians(1);

/// Pairs of frames 0.3 s apart, spread over the recording, between which the poses of the ground truth differ
/// by less than 0.3 degrees of view.
std::vector<FramePair> still_pairs(const recording::Recording& recording, double depth_m) {
  const std::int64_t gap_ns = truth_gap_ns(recording);
  const auto& frames = recording.frames;
  std::vector<FramePair> pairs;
  for (std::size_t i = 0; i < kStillPairs; ++i) {
    const std::size_t from = i * frames.size() / kStillPairs;
    const auto later =
        std::ranges::lower_bound(frames, frames[from].capture_ns + std::llround(1e9 * kStillApart_s), {},
                                 &recording::FrameEntry::capture_ns);
    if (later == frames.end()) continue;
    if (seconds_between(frames[from].capture_ns, later->capture_ns) > 2 * kStillApart_s) continue;
    const auto a = trajectory::interpolate_pose(recording.ground_truth, frames[from].capture_ns, gap_ns);
    const auto b = trajectory::interpolate_pose(recording.ground_truth, later->capture_ns, gap_ns);
    if (!a || !b) continue;
    const double motion_rad =
        rotation_angle_rad(a->rotation, b->rotation) + (a->translation - b->translation).norm() / depth_m;
    if (motion_rad < kTruthStill_rad)
      pairs.push_back({from, static_cast<std::size_t>(later - frames.begin())});
  }
  return pairs;
}

}  // namespace

void check_truth_moves(const recording::Recording& recording, const Workers& workers, Inspection& out) {
  if (!out.truth || !times_are_plausible(out) || out.depth.median_m <= 0 || !truth_is_usable(out)) return;
  if (out.has("frames-out-of-order") || out.has("frames-duplicate-stamp")) return;
  const std::vector<FramePair> pairs = still_pairs(recording, out.depth.median_m);
  if (pairs.size() < kMinStillPairs) return;
  const auto motions = workers.map_chunks<std::optional<double>>(
      pairs.size(), 1, [&](std::size_t i, std::size_t) -> std::optional<double> {
        const auto from = recording.load_frame(pairs[i].from);
        const auto to = recording.load_frame(pairs[i].to);
        if (!from || !to) return std::nullopt;
        const auto moved_px = measures::image_motion_px(from->grey, to->grey);
        if (!moved_px) return std::nullopt;
        return *moved_px / std::abs(recording.rig.camera.fx_px);
      });
  const auto moving = std::ranges::count_if(motions, [](const std::optional<double>& motion_rad) {
    return motion_rad && *motion_rad > kImagesMove_rad;
  });
  if (2 * static_cast<std::size_t>(moving) <= pairs.size()) return;
  const bool everywhere = out.truth->stamps.count > 0 && pairs.size() >= kStillPairs / 2;
  out.add(
      "truth-constant", Severity::error,
      fmt::format("the ground truth stands still while the images move: of {} pairs of frames {:.1f} s "
                  "apart, between which it moves by less than {:.1f} deg of view, the images of {} move by "
                  "more than {:.0f} deg",
                  pairs.size(), kStillApart_s, degrees(kTruthStill_rad), moving, degrees(kImagesMove_rad)),
      everywhere ? "the poses are constant: use another file of poses, or none"
                 : "remove the poses where its source lost the camera, so that they are a gap");
}

}  // namespace fusebench::inspection
