// Hand-held motion of the simulated camera: smooth paths from a seed or a trajectory file (motion_file.hpp),
// as splines for images and inertial samples.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/simulator/motion/motion_heading.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::simulator::motion {

enum class MotionPreset {
  slow,               ///< careful scanning: up to 0.4 m/s and 0.6 rad/s
  fast,               ///< quick pans, back and forth: up to 2 m/s and 3 rad/s
  shake,              ///< shaking at 2 to 4 Hz on a slow path: up to 1.2 m/s and 2.5 rad/s
  sweep,              ///< quick sideways scanning of a near object: up to 2 m/s and 1 rad/s
  realistic_scan,     ///< hand-held scan with tremor: up to 0.5 m/s and 0.8 rad/s
  realistic_turns,    ///< realistic_scan with quick turns: up to 0.8 m/s and 7 rad/s (400 deg/s)
  realistic_revisit,  ///< circular motion that returns to its start every 20 s: up to 0.8 m/s, 1.2 rad/s
  // Presets with a route and their own scenes (routes/preset_routes.hpp):
  loop_room,      ///< two laps along the walls of a furnished room: up to 0.8 m/s, 1.2 rad/s, as most routes
  loop_flat,      ///< through three rooms along a corridor, and back
  corridor,       ///< along a corridor with sparse texture, and back
  shake_revisit,  ///< quiet views of one place, with 2 s of shaking at 200 to 400 deg/s between them
  twin_rooms,     ///< through one of two equal rooms, then through the other one
  no_loop,        ///< along a hall without a repeated view
};
[[nodiscard]] std::string_view to_string(MotionPreset preset);
/// All presets in the order of the enumeration.
[[nodiscard]] std::span<const MotionPreset> motion_presets();
/// Default duration of a recording with the preset.
[[nodiscard]] double usual_duration_s(MotionPreset preset);
/// True if the camera follows a route; false if it moves within a box.
[[nodiscard]] bool follows_route(MotionPreset preset);

struct FrequencyBand {
  double low_hz = 0;
  double high_hz = 0;
};

/// Quick turns, with parameters drawn uniformly between both values.
struct Pans {
  std::array<double, 2> pause_s{0.2, 0.7};
  std::array<double, 2> duration_s{0.45, 0.8};
  std::array<double, 2> rate{1.4, 2.0};  ///< relative peak rate
};

/// Parameters of a hand-held motion. Speeds are those of the colour camera.
struct MotionOptions {
  double peak_speed_mps = 0.4;   ///< limit within the recording; reached except on routes
  double peak_rate_radps = 0.6;  ///< the same for the angular speed
  FrequencyBand position_hz{0.08, 0.30};
  FrequencyBand rotation_hz{0.06, 0.25};
  double pan_share = 0;    ///< share of quick pans in the angular speed, 0 to 1
  double shake_share = 0;  ///< share of shaking in both speeds, 0 to 1
  FrequencyBand shake_hz{2, 4};
  bool sideways = false;     ///< motion across the viewing direction, which is along a world axis
  double tremor_m = 1.5e-4;  ///< amplitude of the hand's tremor during motion
  double tremor_rad = 0;     ///< amplitude of the angular tremor
  FrequencyBand tremor_hz{6, 10};
  Pans pans;
  double mean_pitch_rad = radians(-8.0);  ///< downwards, to floors and tables
  double revisit_s = 0;                   ///< period of a closed path; 0: not closed
  bool from_rest = true;                  ///< starts at rest; otherwise in full motion
  double rest_s = 1.0;                    ///< duration of the rest from the first frame on
  double start_s = 1.0;                   ///< from rest to full motion
};
[[nodiscard]] MotionOptions motion_preset(MotionPreset preset);

/// Time span of the motion. The IMU begins before the first frame and ends after the last one.
struct MotionSpan {
  static constexpr std::int64_t kTail_ns = 100'000'000;  ///< duration of the motion after the last frame

  std::int64_t begin_ns = 0;
  std::int64_t first_frame_ns = 0;
  std::int64_t last_frame_ns = 0;
};

/// A hand-held motion of the colour camera (T_world_camera, world z up) within the box: sums of sines within
/// the bands, mostly horizontal, with small roll and pitch. Peak speeds between the first and the last frame
/// are reached within 1 %. Deterministic. Errors: configuration (an option out of range; a span too short to
/// start from rest; peaks that are not reached; a box that is too small for the speed).
[[nodiscard]] Result<synthetic_imu::PoseSpline> hand_held_motion(const MotionOptions& options,
                                                                 const MotionSpan& span,
                                                                 const Eigen::AlignedBox3d& box,
                                                                 std::uint64_t seed,
                                                                 const HeadingTexture& texture = {});

/// The motion of a body that carries the camera: the same control points, transformed to the body. The spline
/// of the body is exact, and the camera follows its own spline within micrometres.
[[nodiscard]] synthetic_imu::PoseSpline body_motion(const synthetic_imu::PoseSpline& camera,
                                                    const SE3& T_body_camera);

/// Peak speeds of the camera on a moving body, sampled every 5 ms.
struct PeakSpeeds {
  double speed_mps = 0;
  double rate_radps = 0;
};
[[nodiscard]] PeakSpeeds peak_speeds(const synthetic_imu::PoseSpline& body, const SE3& T_body_camera,
                                     std::int64_t begin_ns, std::int64_t end_ns);

/// Path time as a function of recording time: rest, smooth start, then a constant rate; or a constant rate
/// from the start.
struct PathClock {
  double still_until_s = 0;  ///< from the start of the span
  double start_s = 0;        ///< from rest to the full rate; 0: no start
  double rate = 1;           ///< path seconds per second
  double offset_s = 0;       ///< path time at the start

  [[nodiscard]] double path_s(double since_begin_s) const;
};

/// A spline with its control points on a path (T_world_camera by path time).
[[nodiscard]] synthetic_imu::PoseSpline spline_along(const std::function<SE3(double path_s)>& path,
                                                     const PathClock& clock, const MotionSpan& span);

}  // namespace fusebench::simulator::motion
