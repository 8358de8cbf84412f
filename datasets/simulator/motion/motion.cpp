#include "datasets/simulator/motion/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "datasets/simulator/motion/motion_path.hpp"

namespace fusebench::simulator::motion {

namespace {

constexpr std::int64_t kKnotSpacing_ns = 20'000'000;  // resolves the 10 Hz of a tremor
constexpr std::int64_t kSpeedStep_ns = 5'000'000;
constexpr double kMaxStartOffset_s = 8;  // search interval for a start in full motion

Result<void> check_range(std::string_view name, double value, double low, double high) {
  if (value >= low && value <= high) return {};
  return fail(ErrorCode::configuration, fmt::format("{} = {} (allowed {} .. {})", name, value, low, high));
}

Result<void> check_options(const MotionOptions& options, const MotionSpan& span) {
  check(span.begin_ns <= span.first_frame_ns && span.first_frame_ns < span.last_frame_ns, "a span in order");
  for (const auto& [name, value, low, high] :
       {std::tuple{"motion.peak_speed_mps", options.peak_speed_mps, 0.01, 10.0},
        std::tuple{"motion.peak_rate_radps", options.peak_rate_radps, 0.01, 20.0},
        std::tuple{"motion.pan_share", options.pan_share, 0.0, 1.0},
        std::tuple{"motion.shake_share", options.shake_share, 0.0, 1.0},
        std::tuple{"motion.tremor_m", options.tremor_m, 0.0, 0.01},
        std::tuple{"motion.tremor_rad", options.tremor_rad, 0.0, 0.1},
        std::tuple{"motion.mean_pitch_rad", options.mean_pitch_rad, -1.2, 1.2},
        std::tuple{"motion.revisit_s", options.revisit_s, 0.0, 600.0},
        std::tuple{"motion.rest_s", options.rest_s, 0.0, 60.0},
        std::tuple{"motion.start_s", options.start_s, 0.1, 10.0}}) {
    if (const auto valid = check_range(name, value, low, high); !valid) return valid;
  }
  for (const auto& [name, band] :
       {std::pair{"motion.position_hz", options.position_hz},
        std::pair{"motion.rotation_hz", options.rotation_hz}, std::pair{"motion.shake_hz", options.shake_hz},
        std::pair{"motion.tremor_hz", options.tremor_hz}}) {
    if (!(band.low_hz >= 0.01 && band.low_hz < band.high_hz && band.high_hz <= 10)) {
      return fail(ErrorCode::configuration, fmt::format("{} = {} .. {} (allowed: rising, within 0.01 .. 10)",
                                                        name, band.low_hz, band.high_hz));
    }
  }
  const double moving_s = seconds_between(span.first_frame_ns, span.last_frame_ns) - options.rest_s;
  // A recording of 2 s may end one frame earlier, since the motion continues after the last frame.
  if (options.from_rest && moving_s + 1e-9 * static_cast<double>(MotionSpan::kTail_ns) < options.start_s) {
    const double least_s = options.rest_s + options.start_s;
    return fail(
        ErrorCode::configuration,
        fmt::format("duration_s: {:.3f} s from the first frame to the last are too short to start from rest "
                    "(allowed: durations from {:g} s)",
                    moving_s + options.rest_s, least_s),
        fmt::format("--duration {:g} or more, or --in-motion to begin in full motion", least_s));
  }
  return {};
}

/// Parameters that scale a path to a motion.
struct Scale {
  double position_m = 1;
  double angle_rad = 1;
  double heading_rad = 0;  ///< mean viewing direction
};

SE3 pose_on(const HandPath& path, const MotionOptions& options, const Scale& scale, double path_s) {
  const Vector3d angle =
      scale.angle_rad * path.angles(path_s) + options.tremor_rad * path.angle_tremor(path_s);
  const double round_rad = options.revisit_s > 0 ? 2 * std::numbers::pi * path_s / options.revisit_s : 0;
  return {looking(scale.heading_rad + round_rad + angle[0], options.mean_pitch_rad + angle[1], angle[2]),
          scale.position_m * path.position(path_s) + options.tremor_m * path.tremor(path_s)};
}

/// Path time at which the camera moves and rotates at once: the maximum of the smaller of both speeds,
/// relative to their peaks.
double full_motion_s(const HandPath& path) {
  constexpr double kStep_s = 0.05;
  const auto speeds = [&](double path_s) {
    const Vector3d moved = path.position(path_s + kStep_s) - path.position(path_s);
    const Vector3d turned = path.angles(path_s + kStep_s) - path.angles(path_s);
    return Vector2d(moved.norm(), turned.norm());
  };
  const int steps = static_cast<int>(kMaxStartOffset_s / kStep_s);
  Vector2d largest = Vector2d::Zero();
  for (int i = 0; i < steps; ++i) largest = largest.cwiseMax(speeds(i * kStep_s));
  double best = -1;
  double best_s = 0;
  for (int i = 0; i < steps; ++i) {
    const double part = speeds(i * kStep_s).cwiseQuotient(largest).minCoeff();
    if (part > best) {
      best = part;
      best_s = i * kStep_s;
    }
  }
  return best_s;
}

PathClock clock_for(const MotionOptions& options, const MotionSpan& span, const HandPath& path) {
  PathClock clock;
  if (options.from_rest) {
    clock.still_until_s = seconds_between(span.begin_ns, span.first_frame_ns) + options.rest_s;
    clock.start_s = options.start_s;
  } else {
    // The first frame should be in full motion; the lead of the IMU is before it on the path.
    clock.offset_s = full_motion_s(path) - seconds_between(span.begin_ns, span.first_frame_ns);
  }
  return clock;
}

/// Scales the path until both peaks are reached. Positions are linear in their scale except for the tremor,
/// angular velocity is linear in the angles only for small ones, so a few rounds are needed. Error
/// configuration: the peaks are not reached within 1 % (for example with a tremor faster than the peak).
Result<synthetic_imu::PoseSpline> scaled_motion(const HandPath& path, const MotionOptions& options,
                                                const MotionSpan& span, double heading_rad) {
  constexpr int kMaxRounds = 30;
  constexpr double kTolerance = 2e-3;
  constexpr double kPeakTolerance = 1e-2;
  const PathClock clock = clock_for(options, span, path);
  Scale scale{0.5 * options.peak_speed_mps, 0.5 * options.peak_rate_radps, heading_rad};
  for (int round = 0;; ++round) {
    synthetic_imu::PoseSpline spline =
        spline_along([&](double path_s) { return pose_on(path, options, scale, path_s); }, clock, span);
    const PeakSpeeds peaks = peak_speeds(spline, SE3{}, span.first_frame_ns, span.last_frame_ns);
    const double position = options.peak_speed_mps / peaks.speed_mps;
    const double angle = options.peak_rate_radps / peaks.rate_radps;
    const double off = std::max(std::abs(position - 1), std::abs(angle - 1));
    const bool last = round == kMaxRounds || !std::isfinite(off);
    if (off < (last ? kPeakTolerance : kTolerance)) return spline;
    if (last) {
      return fail(
          ErrorCode::configuration,
          fmt::format("motion.peak_speed_mps = {} and motion.peak_rate_radps = {} are not met within "
                      "1 %: {:.4g} m/s and {:.4g} rad/s were reached",
                      options.peak_speed_mps, options.peak_rate_radps, peaks.speed_mps, peaks.rate_radps),
          "take a longer recording, less tremor, or other speeds");
    }
    scale.position_m *= position;
    scale.angle_rad *= angle;
  }
}

double heading_of(const Vector3d& forward_world) { return std::atan2(forward_world.y(), forward_world.x()); }

Vector3d mean_forward(const synthetic_imu::PoseSpline& spline) {
  Vector3d forward = Vector3d::Zero();
  for (const Quaterniond& rotation : spline.rotation_world_body) forward += rotation * Vector3d::UnitZ();
  return forward;
}

/// Heading of a path and weights of its speeds along the world axes.
struct View {
  double heading_rad = 0;
  std::array<double, 3> weight = HandPath::kDefaultAxisWeights;
};

/// unturned: motion with the original heading of the path.
View choose_view(const HandPath& path, const MotionOptions& options,
                 const synthetic_imu::PoseSpline& unturned, const HeadingTexture& texture) {
  const double best_rad = path.mean_yaw_rad() + texture.best_turn_rad(unturned);
  // Angles are sums of sines with a non-zero mean over a short recording.
  const double lean_rad = heading_of(mean_forward(unturned)) - path.mean_yaw_rad();
  if (!options.sideways) {
    if (!texture.face_rad) return {best_rad};
    return {options.revisit_s > 0 ? *texture.face_rad : *texture.face_rad - lean_rad};
  }
  constexpr double kForward = 0.15;
  constexpr double kUp = 0.45;
  const double wanted_rad = texture.only_rad.value_or(best_rad + lean_rad);
  constexpr double kQuarter_rad = 0.5 * std::numbers::pi;
  const double quarters = std::round(wanted_rad / kQuarter_rad);
  const bool along_x = std::fmod(quarters, 2) == 0;
  return {kQuarter_rad * quarters - lean_rad,
          along_x ? std::array{kForward, 1.0, kUp} : std::array{1.0, kForward, kUp}};
}

/// Bounding box of the control points, which contains the spline.
Eigen::AlignedBox3d extent_of(const synthetic_imu::PoseSpline& spline) {
  Eigen::AlignedBox3d extent;
  for (const Vector3d& point : spline.position_world_m) extent.extend(point);
  return extent;
}

/// Position of the middle of the path: the middle of the box, moved towards the mean viewing direction by
/// most of the available space, so that surfaces are close enough for depth cameras. The height is that of
/// the middle.
Vector3d middle_of_path(const synthetic_imu::PoseSpline& spline, const Eigen::AlignedBox3d& box,
                        const Vector3d& size_m) {
  constexpr double kShare = 0.6;
  Vector3d forward = mean_forward(spline);
  forward.z() = 0;
  forward /= std::max(forward.norm(), 1e-9);
  return box.center() + 0.5 * kShare * (box.sizes() - size_m).cwiseProduct(forward);
}

}  // namespace

double PathClock::path_s(double since_begin_s) const {
  const double moving_s = since_begin_s - still_until_s;
  if (start_s <= 0) return offset_s + rate * moving_s;
  if (moving_s <= 0) return offset_s;
  // The rate increases as u^2 (3 - 2u), so the acceleration is continuous at both ends.
  const double u = std::min(moving_s / start_s, 1.0);
  const double started_s = start_s * u * u * u * (1 - 0.5 * u);
  return offset_s + rate * (started_s + std::max(moving_s - start_s, 0.0));
}

synthetic_imu::PoseSpline spline_along(const std::function<SE3(double path_s)>& path, const PathClock& clock,
                                       const MotionSpan& span) {
  synthetic_imu::PoseSpline spline(span.begin_ns, span.last_frame_ns + MotionSpan::kTail_ns, kKnotSpacing_ns);
  for (std::size_t i = 0; i < spline.position_world_m.size(); ++i) {
    const double since_begin_s = seconds_between(span.begin_ns, spline.control_time_ns(i));
    const SE3 pose = path(clock.path_s(since_begin_s));
    spline.position_world_m[i] = pose.translation;
    spline.rotation_world_body[i] = pose.rotation;
  }
  return spline;
}

PeakSpeeds peak_speeds(const synthetic_imu::PoseSpline& body, const SE3& T_body_camera, std::int64_t begin_ns,
                       std::int64_t end_ns) {
  PeakSpeeds peaks;
  for (std::int64_t time_ns = begin_ns; time_ns <= end_ns; time_ns += kSpeedStep_ns) {
    const synthetic_imu::Kinematics k = body.evaluate(time_ns);
    const Vector3d& rate = k.angular_velocity_body_radps;
    const Vector3d velocity =
        k.velocity_world_mps + k.T_world_body.rotation * rate.cross(T_body_camera.translation);
    peaks.speed_mps = std::max(peaks.speed_mps, velocity.norm());
    peaks.rate_radps = std::max(peaks.rate_radps, rate.norm());
  }
  return peaks;
}

synthetic_imu::PoseSpline body_motion(const synthetic_imu::PoseSpline& camera, const SE3& T_body_camera) {
  synthetic_imu::PoseSpline body = camera;
  const SE3 T_camera_body = T_body_camera.inverse();
  for (std::size_t i = 0; i < body.position_world_m.size(); ++i) {
    const SE3 pose = SE3{camera.rotation_world_body[i], camera.position_world_m[i]} * T_camera_body;
    body.position_world_m[i] = pose.translation;
    body.rotation_world_body[i] = pose.rotation;
  }
  return body;
}

Result<synthetic_imu::PoseSpline> hand_held_motion(const MotionOptions& options, const MotionSpan& span,
                                                   const Eigen::AlignedBox3d& box, std::uint64_t seed,
                                                   const HeadingTexture& texture) {
  if (const auto valid = check_options(options, span); !valid) return tl::unexpected(valid.error());
  constexpr int kMaxTries = 40;
  const double length_s = seconds_between(span.begin_ns, span.last_frame_ns) + kMaxStartOffset_s + 1;
  const Vector3d room_m = box.sizes();
  Vector3d stretch = Vector3d::Ones();
  const HandPath path(options, seed, stretch, length_s);
  const auto unturned = scaled_motion(path, options, span, path.mean_yaw_rad());
  if (!unturned) return unturned;
  const View view = choose_view(path, options, *unturned, texture);
  for (int attempt = 0; attempt < kMaxTries; ++attempt) {
    auto spline = scaled_motion(HandPath(options, seed, stretch, length_s, view.weight), options, span,
                                view.heading_rad);
    if (!spline) return spline;
    const Eigen::AlignedBox3d extent = extent_of(*spline);
    const Vector3d size_m = extent.sizes();
    if ((size_m.array() <= room_m.array()).all()) {
      const Vector3d shift = middle_of_path(*spline, box, size_m) - extent.center();
      for (Vector3d& point : spline->position_world_m) point += shift;
      return spline;
    }
    // Same speed in less space: higher frequency along the axes that are too long.
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (size_m[axis] > room_m[axis]) stretch[axis] *= 1.15;
    }
  }
  return fail(ErrorCode::configuration,
              fmt::format("motion.peak_speed_mps = {} cannot be reached within the free {:.2f} x {:.2f} x "
                          "{:.2f} m of the scene",
                          options.peak_speed_mps, room_m.x(), room_m.y(), room_m.z()),
              "take a lower speed or a larger scene");
}

}  // namespace fusebench::simulator::motion
