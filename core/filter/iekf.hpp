// The iterated extended Kalman update (Eqs. 15-23 of the paper) as Gauss-Newton on the MAP cost
//
//   J(x) = 1/2 |x (-) x_prior|^2_P + cost(pose of x)
//
// (Bell & Cathey 1993). The paper's Eq. 22 drops the prior term after the first iteration; here it is in
// every one (iekf.prior_in_every_iteration). A measurement depends on few linear combinations B d of the
// error state only (pose_clones.hpp), so the optimum is x_prior (+) P B^T y for some y in R^28: the update
// iterates on y, never inverts P (which may be singular), and carries velocity, biases and gravity along by
// their correlations.
#pragma once

#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"
#include "core/filter/pose_clones.hpp"

namespace fusebench::filter {

/// Second-order model of a measurement's cost around a pose, in the tangent space of the pose there
/// (right rotation in rad, then world position in m).
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

/// The pose of the IMU if the reference frame (by_reference) or the model (by_model) is kept at its prior
/// pose. The two differ by the corrections of these during the update.
struct PoseHypothesis {
  SE3 T_world_imu_by_reference;
  SE3 T_world_imu_by_model;
};

/// Tangents of the two poses of a hypothesis: by reference, then by model.
using TangentVector = Eigen::Matrix<double, 2 * kPoseSize, 1>;

/// Errors of the timing (read-out of colour, read-out of depth, delay of depth; s), then the number 0, and
/// errors of the pose's rate (as pose_rate()), against that of the reference and of the model. A measurement
/// that has a known displacement counts it in the column of the 0, and says -1 in `undone` there.
using ReadoutVector = Eigen::Matrix<double, kReadoutSize, 1>;

/// How the cost of a measurement depends on these, around none: by the information that it shares with the
/// pose, and by its own.
struct ReadoutQuadratic {
  Eigen::Matrix<double, kPoseSize, kReadoutSize> with_pose =
      Eigen::Matrix<double, kPoseSize, kReadoutSize>::Zero();
  Eigen::Matrix<double, kReadoutSize, kReadoutSize> information =
      Eigen::Matrix<double, kReadoutSize, kReadoutSize>::Zero();
  ReadoutVector gradient = ReadoutVector::Zero();

  /// What the errors add to the cost if the pose has moved on by a step.
  [[nodiscard]] double cost(const ReadoutVector& errors, const Vector6d& step) const;
};

/// The cost of a measurement, in the tangents of the two poses of a hypothesis and in errors of the read-out.
/// The poses' parts are those without such errors.
struct MeasurementQuadratic {
  PoseQuadratic by_reference;
  PoseQuadratic by_model;
  ReadoutQuadratic readout_by_reference = {};
  ReadoutQuadratic readout_by_model = {};
  /// What the images were prepared for already, counted from the prior.
  ReadoutVector undone = ReadoutVector::Zero();

  /// errors: counted from the prior. steps: that the poses have moved on by since the linearisation.
  [[nodiscard]] double readout_cost(const ReadoutVector& errors, const TangentVector& steps) const;
  [[nodiscard]] double cost(const ReadoutVector& errors = ReadoutVector::Zero()) const;
};

/// How the cost depends on the timing around a pose and a timing, in addition to a PoseQuadratic there: for
/// estimators that put a pose and a timing of their own in.
struct PoseTimingQuadratic {
  Vector3d timing_s = Vector3d::Zero();  ///< around which: as SensorErrors count it
  Eigen::Matrix<double, kPoseSize, kTimingSize> with_pose =
      Eigen::Matrix<double, kPoseSize, kTimingSize>::Zero();  ///< information shared with the pose's tangent
  Matrix3d information = Matrix3d::Zero();
  Vector3d gradient = Vector3d::Zero();
};

using MeasuredVector = Eigen::Matrix<double, kMeasuredSize, 1>;
using MeasuredMatrix = Eigen::Matrix<double, kMeasuredSize, kMeasuredSize>;

/// Interface of a measurement to the update. Nuisance parameters (brightness of patches) are internal to the
/// measurement: it eliminates them in linearise() and moves them along in trial_cost() and accept().
class PoseMeasurement {
 public:
  PoseMeasurement() = default;
  PoseMeasurement(const PoseMeasurement&) = delete;
  PoseMeasurement& operator=(const PoseMeasurement&) = delete;
  virtual ~PoseMeasurement() = default;

  /// Number of resolutions, coarse to fine; the last one is full resolution.
  [[nodiscard]] virtual int stages() const { return 1; }
  /// Fixes associations, visibility and robust weights at the pose (those of an earlier linearisation may
  /// do). `gate`: reject what is inconsistent.
  [[nodiscard]] virtual MeasurementQuadratic linearise(const PoseHypothesis& poses, int stage, bool gate) = 0;
  /// Cost at other poses with associations and weights of the last linearise(), without a timing error;
  /// `step` is the full tangent step from there, of which `fraction` was taken.
  [[nodiscard]] virtual double trial_cost(const PoseHypothesis& poses, const TangentVector& step,
                                          double fraction) = 0;
  /// The last trial becomes the current estimate.
  virtual void accept() = 0;
};

struct IekfResult {
  GaussianState posterior;
  MeasuredVector solution = MeasuredVector::Zero();  ///< y of the last iterate
  PoseQuadratic measurement;   ///< the last linearisation, at the posterior, without the prior
  PoseTimingQuadratic timing;  ///< the same, around the timing of the last iterate
  /// How the measurement by the model moved the pose, which without it would be elsewhere: tangent of
  /// T_world_imu (rotation in rad, world position in m).
  Vector6d correction_by_model = Vector6d::Zero();
  int iterations = 0;         ///< accepted steps over all stages
  bool converged = false;     ///< the last step was below both thresholds
  double map_cost_prior = 0;  ///< J at the prediction (last stage only)
  double map_cost_posterior = 0;
};

/// Its correction_by_model with the translation along the axes of the IMU.
[[nodiscard]] Vector6d correction_in_imu(const IekfResult& update);

/// The start of an update at another pose than the prediction's: the y that brings both poses of the
/// hypothesis to T_world_imu, as far as the prior's covariance lets them.
[[nodiscard]] MeasuredVector start_at(const GaussianState& prior, const SE3& T_world_imu);

/// What an update does with the constants of the sensors (kImuTimeOffset to kDepthDelay).
enum class SensorConstants {
  estimated,
  /// Their uncertainty counts and they stay as they are (Schmidt 1966): before there was motion, what seems
  /// to be measured of them is mostly the error of something else.
  considered,
};

/// Runs the update. The covariance is updated once, after the last iteration (Eq. 23 in its symmetric form),
/// and carried to the tangent space at the posterior. `start` is the y of the first iterate (zero: the
/// prediction).
[[nodiscard]] IekfResult iekf_update(const GaussianState& prior, PoseMeasurement& measurement,
                                     const config::IekfConfig& config,
                                     const MeasuredVector& start = MeasuredVector::Zero(),
                                     SensorConstants constants = SensorConstants::estimated);

}  // namespace fusebench::filter
