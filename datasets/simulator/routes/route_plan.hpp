// A planned camera path: key poses by time, and the smooth path along them.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::simulator::routes {

/// Where the camera is and looks at a time of the route. Headings are about world z (0 looks along x) and not
/// reduced to one turn; pitch is up.
struct KeyPose {
  double time_s = 0;
  Vector3d position_world_m = Vector3d::Zero();
  double heading_rad = 0;
  double pitch_rad = 0;
};

/// Speeds between key poses; whichever takes longer decides when the next one is reached.
struct RouteSpeeds {
  double speed_mps = 0.65;
  double rate_radps = 0.9;  ///< of heading and pitch, each
};

/// Key poses one after the other. Between two of them position, heading and pitch are linear in time.
class RoutePlan {
 public:
  RoutePlan(const RouteSpeeds& speeds, const KeyPose& start) : speeds_(speeds), poses_{start} {}

  /// Turns the shorter way to the heading (modulo a turn) while moving.
  void move_to(const Vector3d& position_world_m, double heading_rad, double pitch_rad);
  /// The heading is taken as it is, and the time is given.
  void swing_to(const Vector3d& position_world_m, double heading_rad, double pitch_rad, double duration_s);
  void stay(double duration_s);

  [[nodiscard]] const KeyPose& last() const { return poses_.back(); }
  /// Before the first key pose and after the last one: that one.
  [[nodiscard]] KeyPose at(double time_s) const;

 private:
  RouteSpeeds speeds_;
  std::vector<KeyPose> poses_;
};

/// The uniform cubic B-spline (T_world_camera; camera x right, y down, z forward) whose control points lie on
/// the plan every spacing_s, from three spacings before time 0 to three after the plan's end, where it is at
/// rest. Twice continuously differentiable, and no faster than the plan; corners are rounded within two
/// spacings.
[[nodiscard]] synthetic_imu::PoseSpline smooth_route(const RoutePlan& plan, double spacing_s);

}  // namespace fusebench::simulator::routes
