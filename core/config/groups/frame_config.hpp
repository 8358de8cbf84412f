// Options: what is done to a frame before it is used.
#pragma once

namespace fusebench::config {

/// Gates and noise of depth measurements.
struct DepthConfig {
  double min_m = 0.3;
  double max_m = 5.0;
  double noise_floor_m = 0.0012;
  double noise_quadratic_per_m = 0.0019;
  double noise_offset_m = 0.4;
  double edge_jump = 0.03;
  double max_incidence_deg = 75.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("min_m", self.min_m, 0.0, 100.0, "depth below this is ignored (metres)");
    v.number("max_m", self.max_m, 0.01, 100.0, "depth above this is ignored (metres)");
    v.number(
        "noise_floor_m", self.noise_floor_m, 1e-5, 1.0,
        "a in the depth noise sigma(z) = a + b (z - c)^2 (metres; Nguyen et al. 2012 for structured light)");
    v.number("noise_quadratic_per_m", self.noise_quadratic_per_m, 0.0, 1.0, "b of the depth noise (1/m)");
    v.number("noise_offset_m", self.noise_offset_m, 0.0, 10.0, "c of the depth noise (metres)");
    v.number("edge_jump", self.edge_jump, 0.001, 1.0,
             "a pixel is an edge and not used if the depth in its 3x3 neighbourhood changes by more than "
             "this share of it");
    v.number("max_incidence_deg", self.max_incidence_deg, 10.0, 89.0,
             "surfaces seen more obliquely than this are not used (degrees between ray and normal)");
  }
};

/// When a frame that was compensated for the predicted motion is compensated again for the estimated one:
/// for another update, and before it is fused.
struct CompensationConfig {
  /// A frame is compensated again before it is fused if the update changed the angular velocity by more
  /// (rad/s): over half a read-out of 13 ms at a focal length of 520 px that moves a pixel by a third of one.
  static constexpr double redo_angular_velocity_radps = 0.05;
  /// The same for the linear velocity (m/s); at a distance of 1 m it moves a pixel as far.
  static constexpr double redo_velocity_mps = 0.05;
  /// A frame is compensated and the update made once more if the update changed the angular velocity by more
  /// (rad/s): the update undoes small changes by itself; over half a read-out of 13 ms at a focal length of
  /// 520 px this moves a pixel by one.
  static constexpr double update_again_angular_velocity_radps = 0.15;
  /// The same for the linear velocity (m/s), which images alone tell no better from frame to frame.
  static constexpr double update_again_velocity_mps = 0.3;
  int max_updates_again = 1;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("max_updates_again", self.max_updates_again, 0, 10,
             "largest number of further updates of a frame");
  }
};

}  // namespace fusebench::config
