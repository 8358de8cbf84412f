// Continuous-time trajectory: uniform cubic B-splines of position (R^3) and orientation (cumulative, SO(3)).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::synthetic_imu {

/// Motion of a body at an instant.
struct Kinematics {
  SE3 T_world_body;
  Vector3d angular_velocity_body_radps = Vector3d::Zero();
  Vector3d velocity_world_mps = Vector3d::Zero();
  Vector3d acceleration_world_mps2 = Vector3d::Zero();
};

/// Weights of the cumulative basis on one segment, value = c0 + sum_j weight[j] (c_{j+1} - c_j) (Sommer et
/// al., CVPR 2020, Sec. 3), and their time derivatives.
struct CumulativeBasis {
  std::array<double, 3> weight{};
  std::array<double, 3> rate{};          ///< 1/s
  std::array<double, 3> acceleration{};  ///< 1/s^2
};

/// Segment of an instant (control points segment to segment + 3) and the basis there.
struct SplinePlace {
  std::size_t segment = 0;
  CumulativeBasis basis;
};

/// Control point i has its maximum weight at start + (i - 1) spacing. Twice continuously differentiable.
class PoseSpline {
 public:
  /// All control points are initially the identity. Covers at least [start_ns, end_ns].
  PoseSpline(std::int64_t start_ns, std::int64_t end_ns, std::int64_t spacing_ns);

  [[nodiscard]] std::int64_t start_ns() const { return start_ns_; }
  [[nodiscard]] std::int64_t spacing_ns() const { return spacing_ns_; }
  [[nodiscard]] std::int64_t control_time_ns(std::size_t i) const {
    return start_ns_ + (static_cast<std::int64_t>(i) - 1) * spacing_ns_;
  }

  /// Instants outside the covered span extrapolate the first or last segment.
  [[nodiscard]] SplinePlace place(std::int64_t timestamp_ns) const;
  [[nodiscard]] Kinematics evaluate(std::int64_t timestamp_ns) const;

  std::vector<Vector3d> position_world_m;        ///< control points
  std::vector<Quaterniond> rotation_world_body;  ///< control points, unit

 private:
  std::int64_t start_ns_;
  std::int64_t spacing_ns_;
};

/// Options of the fit of a spline to measured poses.
///
/// Motion capture has jitter between samples, so the fit must smooth. It minimises
/// sum_i |x(t_i) - x_i|^2 + 1 / (dt (2 pi f)^4) integral |x''|^2 dt,
/// with the gain 1 / (1 + (nu / f)^4) for motion of frequency nu: 1 below the cutoff f. dt is the median
/// spacing of the poses. With f = 12 Hz the residuals of TUM freiburg1_rpy (fast hand-held rotation) are
/// closest to white, so the removed part is mostly noise. The photometric error of images warped by the
/// smoothed ground truth has its minimum there too. The knots must resolve the cutoff: 20 ms resolves 25 Hz.
struct SplineFitOptions {
  double knot_spacing_s = 0.02;
  double cutoff_hz = 12.0;
  double outlier_rotation_rad =
      0.005;  ///< larger residuals count linearly (Huber); about 5 times the usual jitter
  double outlier_position_m = 0.001;
};

struct SplineFit {
  PoseSpline spline;
  double rotation_residual_rad = 0;  ///< rms per axis
  double position_residual_m = 0;    ///< rms per axis
  bool converged = false;
};

/// Fits with one thread; deterministic. Errors: configuration (an option out of range), data_corrupt (fewer
/// than 4 poses, or the solver failed).
[[nodiscard]] Result<SplineFit> fit_pose_spline(const Trajectory& truth, const SplineFitOptions& options);

}  // namespace fusebench::synthetic_imu
