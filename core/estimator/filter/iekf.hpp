// The iterated extended Kalman update (Eqs. 15-23 of the paper) as Gauss-Newton on the MAP cost
//
// J(x) = 1/2 |x (-) x_prior|^2_P + cost(pose of x)
//
// (Bell & Cathey 1993). The paper's Eq. 22 omits the prior term after the first iteration; here it is in
// every iteration (iekf.prior_in_every_iteration). A measurement depends on the error state d only
// through B d in R^28 (pose_clones.hpp). The optimum is therefore x_prior (+) P B^T y for some y in R^28. The
// update iterates on y, never inverts P (which may be singular), and moves velocity, biases and gravity
// through their correlations.
#pragma once

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/filter_state.hpp"
#include "core/estimator/filter/pose_clones.hpp"

namespace fusebench::filter {

/// Second-order model of the cost of a measurement around a pose, in the tangent of the pose (right rotation
/// in rad, then world position in m).
struct PoseQuadratic {
  Matrix6d information = Matrix6d::Zero();  ///< H^T R^-1 H
  Vector6d gradient = Vector6d::Zero();     ///< H^T R^-1 r
  double cost = 0;                          ///< robust cost of the residuals, at the pose

  void add(const PoseQuadratic& other, double factor) {
    information += factor * other.information;
    gradient += factor * other.gradient;
    cost += factor * other.cost;
  }
};

/// The pose of the IMU relative to the reference frame (by_reference) and to the model (by_model), each of
/// these fixed at its prior pose. The two differ by the corrections of reference and model in the update.
struct PoseHypothesis {
  SE3 T_world_imu_by_reference;
  SE3 T_world_imu_by_model;
};

/// Tangents of the two poses of a hypothesis: by reference, then by model.
using TangentVector = Eigen::Matrix<double, 2 * kPoseSize, 1>;

/// Read-out errors e in R^16, relative to the prior:
///
/// e = (dt_color, dt_depth, dt_delay, 0, v_reference, v_model)
///
/// dt: errors of the colour read-out, the depth read-out and the depth delay (s). v (6 entries each): rate of
/// the pose as pose_rate(), minus the rate of the reference and of the model. Entry 3 is the affine term:
/// with compensated[3] = -1, (e - compensated)[3] = 1, so column 3 of a Jacobian is a displacement that does
/// not depend on e.
using ReadoutVector = Eigen::Matrix<double, kReadoutSize, 1>;

/// Quadratic model of the cost in the read-out errors e around 0: the information shared with the pose, and
/// that of e itself.
struct ReadoutQuadratic {
  Eigen::Matrix<double, kPoseSize, kReadoutSize> with_pose =
      Eigen::Matrix<double, kPoseSize, kReadoutSize>::Zero();
  Eigen::Matrix<double, kReadoutSize, kReadoutSize> information =
      Eigen::Matrix<double, kReadoutSize, kReadoutSize>::Zero();
  ReadoutVector gradient = ReadoutVector::Zero();

  /// Cost that the errors add if the pose has moved by `step`.
  [[nodiscard]] double cost(const ReadoutVector& errors, const Vector6d& step) const;
};

/// Quadratic model of the cost of a measurement in the tangents of both poses and in the read-out errors. The
/// pose parts are those for e = 0.
struct MeasurementQuadratic {
  PoseQuadratic by_reference;
  PoseQuadratic by_model;
  ReadoutQuadratic readout_by_reference = {};
  ReadoutQuadratic readout_by_model = {};
  /// Read-out errors for which the images are already compensated, relative to the prior.
  ReadoutVector compensated = ReadoutVector::Zero();

  /// errors: relative to the prior. steps: motion of both poses since the linearisation.
  [[nodiscard]] double readout_cost(const ReadoutVector& errors, const TangentVector& steps) const;
  [[nodiscard]] double cost(const ReadoutVector& errors = ReadoutVector::Zero()) const;
};

/// Quadratic model of the cost in the timing around a pose and a timing, in addition to a PoseQuadratic
/// there. For estimators that have their own pose and timing.
struct PoseTimingQuadratic {
  Vector3d timing_s = Vector3d::Zero();  ///< point of linearisation, as SensorErrors::timing_s()
  /// Information shared with the tangent of the pose.
  Eigen::Matrix<double, kPoseSize, kTimingSize> with_pose =
      Eigen::Matrix<double, kPoseSize, kTimingSize>::Zero();
  Matrix3d information = Matrix3d::Zero();
  Vector3d gradient = Vector3d::Zero();
};

using MeasuredVector = Eigen::Matrix<double, kMeasuredSize, 1>;
using MeasuredMatrix = Eigen::Matrix<double, kMeasuredSize, kMeasuredSize>;

/// A measurement of the update. Nuisance parameters (brightness of patches) are internal: linearise()
/// eliminates them, trial_cost() and accept() update them.
class PoseMeasurement {
 public:
  PoseMeasurement() = default;
  PoseMeasurement(const PoseMeasurement&) = delete;
  PoseMeasurement& operator=(const PoseMeasurement&) = delete;
  virtual ~PoseMeasurement() = default;

  /// Number of resolutions, coarse to fine; the last one is full resolution.
  [[nodiscard]] virtual int stages() const { return 1; }
  /// Fixes associations, visibility and robust weights at the pose; those of an earlier linearisation may be
  /// reused. gate: reject inconsistent patches.
  [[nodiscard]] virtual MeasurementQuadratic linearise(const PoseHypothesis& poses, int stage, bool gate) = 0;
  /// Cost at other poses with the associations and weights of the last linearise(), for zero timing errors.
  /// `step`: the full tangent step from there; `fraction`: the part of it that was taken.
  [[nodiscard]] virtual double trial_cost(const PoseHypothesis& poses, const TangentVector& step,
                                          double fraction) = 0;
  /// Makes the last trial the current estimate.
  virtual void accept() = 0;
};

struct IekfResult {
  GaussianState posterior;
  MeasuredVector solution = MeasuredVector::Zero();  ///< y of the last iterate
  PoseQuadratic measurement;   ///< last linearisation, at the posterior, without the prior
  PoseTimingQuadratic timing;  ///< as `measurement`, around the timing of the last iterate
  /// Motion of the pose caused by the measurement by the model: tangent of T_world_imu (rotation in rad,
  /// world position in m).
  Vector6d correction_by_model = Vector6d::Zero();
  int iterations = 0;         ///< accepted steps over all stages
  bool converged = false;     ///< the last step was below both thresholds
  double map_cost_prior = 0;  ///< J at the prediction (last stage only)
  double map_cost_posterior = 0;
};

/// correction_by_model with the translation along the axes of the IMU.
[[nodiscard]] Vector6d correction_in_imu(const IekfResult& update);

/// The y that moves both poses of the hypothesis to T_world_imu, as far as the covariance of the prior
/// permits. Starts an update at a pose other than the prediction.
[[nodiscard]] MeasuredVector start_at(const GaussianState& prior, const SE3& T_world_imu);

/// Treatment of the sensor constants (kImuTimeOffset to kDepthDelay) in an update.
enum class SensorConstants {
  estimated,
  /// The values stay fixed, and their uncertainty counts (Schmidt 1966). Used before there is motion, when
  /// their apparent errors are mostly errors of other states.
  considered,
};

/// Runs the update. The covariance is updated once, after the last iteration (Eq. 23 in its symmetric form),
/// and transported to the tangent space at the posterior. `start`: y of the first iterate (zero: the
/// prediction).
[[nodiscard]] IekfResult iekf_update(const GaussianState& prior, PoseMeasurement& measurement,
                                     const config::IekfConfig& config,
                                     const MeasuredVector& start = MeasuredVector::Zero(),
                                     SensorConstants constants = SensorConstants::estimated);

}  // namespace fusebench::filter
