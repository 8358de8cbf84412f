// A ground truth that stands still while the images move.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/trajectory/trajectory.hpp"
#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/camera_turns.hpp"
#include "datasets/inspection/warp_pairs.hpp"

namespace fusebench::inspection {

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
