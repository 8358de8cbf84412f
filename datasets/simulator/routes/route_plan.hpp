// A planned camera path: key poses by time, and the smooth path along them.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::simulator::routes {

/// Pose of the camera at a time of the route. Headings are about world z (0 is along x), not reduced to one
/// turn; pitch is up.
struct KeyPose {
  double time_s = 0;
  Vector3d position_world_m = Vector3d::Zero();
  double heading_rad = 0;
  double pitch_rad = 0;
};

/// Speeds between key poses; the slower of translation and rotation determines the time of the next one.
struct RouteSpeeds {
  double speed_mps = 0.65;
  double rate_radps = 0.9;  ///< of heading and of pitch
};

/// A sequence of key poses. Position, heading and pitch are linear in time between them.
class RoutePlan {
 public:
  RoutePlan(const RouteSpeeds& speeds, const KeyPose& start) : speeds_(speeds), poses_{start} {}

  /// Moves to a pose, with the shorter rotation to the heading (modulo a turn).
  void move_to(const Vector3d& position_world_m, double heading_rad, double pitch_rad);
  /// Moves with the heading as given (no reduction) in the given time.
  void swing_to(const Vector3d& position_world_m, double heading_rad, double pitch_rad, double duration_s);
  void stay(double duration_s);

  [[nodiscard]] const KeyPose& last() const { return poses_.back(); }
  /// Before the first key pose: the first one; after the last: the last one.
  [[nodiscard]] KeyPose at(double time_s) const;

 private:
  RouteSpeeds speeds_;
  std::vector<KeyPose> poses_;
};

/// Uniform cubic B-spline (T_world_camera; camera x right, y down, z forward) with control points on the plan
/// every spacing_s, from three spacings before time 0 to three after the end of the plan, where it is at
/// rest. Twice continuously differentiable and not faster than the plan; corners are rounded within two
/// spacings.
[[nodiscard]] synthetic_imu::PoseSpline smooth_route(const RoutePlan& plan, double spacing_s);

}  // namespace fusebench::simulator::routes
