// A continuous-time trajectory: uniform cubic B-splines of position (in R^3) and of orientation (cumulative,
// on SO(3)).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::synthetic_imu {

/// The state of a moving body at one time.
struct Kinematics {
  SE3 T_world_body;
  Vector3d angular_velocity_body_radps = Vector3d::Zero();
  Vector3d velocity_world_mps = Vector3d::Zero();
  Vector3d acceleration_world_mps2 = Vector3d::Zero();
};

/// Weights of the cumulative basis: value = c0 + sum_j weight[j] (c_{j+1} - c_j) on one segment (Sommer et
/// al., CVPR 2020, Sec. 3), and their derivatives by time.
struct CumulativeBasis {
  std::array<double, 3> weight{};
  std::array<double, 3> rate{};          ///< 1/s
  std::array<double, 3> acceleration{};  ///< 1/s^2
};

/// Where a time lies: the segment (control points segment to segment + 3) and the basis there.
struct SplinePlace {
  std::size_t segment = 0;
  CumulativeBasis basis;
};

/// Control point i acts mostly at start + (i - 1) spacing. Twice continuously differentiable.
class PoseSpline {
 public:
  /// All control points start as identity. Covers at least [start_ns, end_ns].
  PoseSpline(std::int64_t start_ns, std::int64_t end_ns, std::int64_t spacing_ns);

  [[nodiscard]] std::int64_t start_ns() const { return start_ns_; }
  [[nodiscard]] std::int64_t spacing_ns() const { return spacing_ns_; }
  [[nodiscard]] std::int64_t control_time_ns(std::size_t i) const {
    return start_ns_ + (static_cast<std::int64_t>(i) - 1) * spacing_ns_;
  }

  /// Times outside of the covered span extend the first or last segment.
  [[nodiscard]] SplinePlace place(std::int64_t timestamp_ns) const;
  [[nodiscard]] Kinematics evaluate(std::int64_t timestamp_ns) const;

  std::vector<Vector3d> position_world_m;        ///< control points
  std::vector<Quaterniond> rotation_world_body;  ///< control points, unit

 private:
  std::int64_t start_ns_;
  std::int64_t spacing_ns_;
};

/// How a spline is fitted to measured poses.
///
/// Motion capture jitters from sample to sample, so the fit must smooth. It minimises
///   sum_i |x(t_i) - x_i|^2 + 1 / (dt (2 pi f)^4) integral |x''|^2 dt,
/// which passes motion of frequency nu with the gain 1 / (1 + (nu / f)^4): 1 below the cutoff f, where dt is
/// the median spacing of the poses. f = 12 Hz is where the residuals of TUM freiburg1_rpy (fast hand-held
/// rotation) are closest to white, i.e. where what is taken away looks like noise rather than motion; the
/// photometric error of warping images by the smoothed truth has its minimum there, too. The knots only have
/// to resolve the cutoff: 20 ms carries 25 Hz.
struct SplineFitOptions {
  double knot_spacing_s = 0.02;
  double cutoff_hz = 12.0;
  double outlier_rotation_rad =
      0.005;  ///< residuals above count linearly (Huber); about 5 times the usual jitter
  double outlier_position_m = 0.001;
};

struct SplineFit {
  PoseSpline spline;
  double rotation_residual_rad = 0;  ///< rms per axis
  double position_residual_m = 0;    ///< rms per axis
  bool converged = false;
};

/// Fits with one thread; the result depends on nothing but the arguments. Errors: configuration (an option
/// out of range), data_corrupt (fewer than 4 poses, or the solver failed).
[[nodiscard]] Result<SplineFit> fit_pose_spline(const Trajectory& truth, const SplineFitOptions& options);

}  // namespace fusebench::synthetic_imu
