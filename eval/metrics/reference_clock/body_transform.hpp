// Where the estimate's body sits in the reference's body (hand-eye calibration), and the scale of the
// estimate.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/base/geometry.hpp"

namespace fusebench::reference_clock {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;
using BodyJacobian = Eigen::Matrix<double, 6, 7>;

/// Rotation R and offset o of the estimate's body in the reference's, and the scale s that multiplies the
/// estimate's lengths. An estimated motion (R_B, t_B) is, of the reference's body,
///
///   R_A = R R_B R^T,   t_A = s R t_B + (I - R_A) o.
struct BodyTransform {
  Quaterniond rotation = Quaterniond::Identity();
  Vector3d offset_m = Vector3d::Zero();
  double scale = 1;

  [[nodiscard]] SE3 operator()(const SE3& estimated) const;

  /// Derivative of (R_A, t_A) in the tangent of pose_minus() (rad, m) by (phi, o, s), with R -> Exp(phi) R.
  [[nodiscard]] BodyJacobian jacobian(const SE3& estimated) const;

  /// Adds (phi, o, s).
  void step(const Vector7d& delta);
};

/// Standard deviations of residuals, by which rotations and translations are weighted.
struct MotionSigmas {
  double rotation_rad = 0.01;
  double translation_m = 0.01;
};

/// Two motions that belong together.
struct MotionPair {
  SE3 reference;
  SE3 estimated;
};

/// The transform of the pairs without a start: R from rotation vectors and translations (Kabsch 1976), o and
/// s by linear least squares, both twice in turn. weights: one a pair.
[[nodiscard]] BodyTransform rough_transform(std::span<const MotionPair> pairs,
                                            std::span<const double> weights, const MotionSigmas& sigmas);

/// Information of (phi, o, s) without any motion: o = 0 +- 1 m, s = 1 +- 0.3, and phi +- pi. It keeps
/// directions that the motion does not determine where they are.
[[nodiscard]] Matrix7d prior_information();
/// Half the gradient of the prior's cost at a transform.
[[nodiscard]] Vector7d prior_gradient(const BodyTransform& transform);

}  // namespace fusebench::reference_clock
