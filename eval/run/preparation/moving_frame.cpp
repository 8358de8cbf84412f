#include "eval/run/preparation/moving_frame.hpp"

#include <fmt/format.h>

#include <array>
#include <span>
#include <utility>

#include "core/config/config.hpp"
#include "core/config/variants.hpp"
#include "core/estimator/patches/posed_camera.hpp"
#include "core/recording_estimator.hpp"

namespace fusebench::preparation {

namespace {

constexpr int kSmallWidth_px = 320;
constexpr std::size_t kVelocityReach = 2;  // frames on either side that a velocity is made of

struct TimedPose {
  std::int64_t capture_ns = 0;
  SE3 T_world_camera;
};

/// Every `step`-th pixel.
template <class Pixel>
Image<Pixel> thinned(const Image<Pixel>& image, int step) {
  Image<Pixel> small((image.width + step - 1) / step, (image.height + step - 1) / step);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) small(x, y) = image(step * x, step * y);
  }
  return small;
}

RgbdFrame small_frame(RgbdFrame frame, int levels) {
  if (levels == 0) return frame;
  frame.grey = std::move(build_pyramid(frame.grey, levels + 1).back());
  frame.color = thinned(frame.color, 1 << levels);
  frame.depth_m = thinned(frame.depth_m, 1 << levels);
  return frame;
}

Result<std::vector<MovingFrame>> load_small(const recording::Recording& recording, std::size_t begin,
                                            std::size_t end, int levels, const Workers& workers) {
  using Loaded = std::optional<Result<RgbdFrame>>;
  std::vector<Loaded> loaded =
      workers.map_chunks<Loaded>(end - begin, 1, [&](std::size_t i, std::size_t) -> Loaded {
        auto frame = recording.load_frame(begin + i);
        if (!frame) return frame;
        return Result<RgbdFrame>(small_frame(*std::move(frame), levels));
      });
  std::vector<MovingFrame> frames;
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    if (!*loaded[i])
      return fail(loaded[i]->error().code, fmt::format("frame {}: {}", begin + i, loaded[i]->error().message),
                  loaded[i]->error().hint);
    frames.push_back({**std::move(loaded[i]), std::nullopt});
  }
  return frames;
}

/// Of the frames that are tracked.
Result<std::vector<std::optional<TimedPose>>> track(const std::vector<MovingFrame>& frames,
                                                    const SensorRig& rig, const Workers& workers,
                                                    const std::atomic<bool>* stop) {
  const config::EffectiveConfig config = config::variant_config(config::find_variant("no-imu").value());
  core::RecordingEstimator estimator(config.values(), rig, {}, workers);
  std::vector<std::optional<TimedPose>> poses;
  for (const MovingFrame& moving : frames) {
    if (stop != nullptr && stop->load()) return fail(ErrorCode::run_failed, "stopped by the user");
    const auto report = estimator.process(moving.frame);
    if (!report) return tl::unexpected(report.error());
    poses.emplace_back();
    if (health::is_in_map(report->status))
      poses.back() = TimedPose{report->capture_ns, report->T_world_camera};
  }
  return poses;
}

/// The derivative at the middle pose of the polynomial through the motions from there to the others
/// (Lagrange).
Vector6d twist_of(std::span<const std::optional<TimedPose>, 2 * kVelocityReach + 1> poses) {
  const TimedPose& middle = *poses[kVelocityReach];
  std::array<double, 2 * kVelocityReach + 1> time_s{};
  for (std::size_t i = 0; i < poses.size(); ++i)
    time_s[i] = seconds_between(middle.capture_ns, poses[i]->capture_ns);
  Vector6d twist = Vector6d::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i == kVelocityReach) continue;
    double weight = 1 / time_s[i];
    for (std::size_t j = 0; j < poses.size(); ++j) {
      if (j != i && j != kVelocityReach) weight *= -time_s[j] / (time_s[i] - time_s[j]);
    }
    const SE3 moved = middle.T_world_camera.inverse() * poses[i]->T_world_camera;
    twist.head<3>() += weight * so3_log(moved.rotation);
    twist.tail<3>() += weight * moved.translation;
  }
  return twist;
}

}  // namespace

Result<MovingFrames> moving_frames(const recording::Recording& recording, std::size_t begin, std::size_t end,
                                   const Workers& workers, const std::atomic<bool>* stop) {
  int levels = 0;
  while ((recording.rig.camera.width_px >> levels) > kSmallWidth_px) ++levels;
  SensorRig rig = recording.rig;
  rig.camera = patches::camera_at_level(recording.rig.camera, levels);
  auto frames = load_small(recording, begin, end, levels, workers);
  if (!frames) return tl::unexpected(frames.error());
  const auto poses = track(*frames, rig, workers, stop);
  if (!poses) return tl::unexpected(poses.error());
  for (MovingFrame& moving : *frames) moving.frame.color = {};
  const auto is_known = [](const std::optional<TimedPose>& pose) { return pose.has_value(); };
  for (std::size_t k = kVelocityReach; k + kVelocityReach < poses->size(); ++k) {
    const std::span<const std::optional<TimedPose>, 2 * kVelocityReach + 1> around(
        &(*poses)[k - kVelocityReach], 2 * kVelocityReach + 1);
    if (std::ranges::all_of(around, is_known))
      (*frames)[k].motion = CameraMotion{(*poses)[k]->T_world_camera, twist_of(around)};
  }
  return MovingFrames{rig.camera, *std::move(frames)};
}

}  // namespace fusebench::preparation
