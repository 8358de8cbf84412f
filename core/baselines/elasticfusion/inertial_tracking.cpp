#include "core/baselines/elasticfusion/inertial_tracking.hpp"

#include <optional>

#include "core/base/solvers.hpp"
#include "core/config/config.hpp"
#include "core/estimator/prediction/initialisation.hpp"
#include "core/estimator/prediction/motion_prior.hpp"

namespace fusebench::baselines::elasticfusion {

namespace {

// Pixels share errors (blur, calibration, holes of the model): this number counts as one independent
// measurement.
constexpr double kPixelsPerMeasurement = 100;
constexpr double kLeastScatter = 1e-9;    // for images without texture or depth along some direction
constexpr double kLeastVariance = 1e-12;  // of the predicted pose (rad^2, m^2)

/// Derivative of the step of T_view_camera (on the left: rotation, then translation) by the pose of the IMU
/// (rotation on the right, world position).
Matrix6d step_by_pose(const SE3& T_world_view, const SE3& T_view_camera, const SE3& T_imu_camera) {
  const Matrix3d R_view_world = T_world_view.rotation_matrix().transpose();
  const Matrix3d R_view_imu = T_view_camera.rotation_matrix() * T_imu_camera.rotation_matrix().transpose();
  Matrix6d jacobian = Matrix6d::Zero();
  jacobian.topLeftCorner<3, 3>() = R_view_imu;
  jacobian.bottomLeftCorner<3, 3>() =
      hat(T_view_camera.translation) * R_view_imu - R_view_imu * hat(T_imu_camera.translation);
  jacobian.bottomRightCorner<3, 3>() = R_view_world;
  return jacobian;
}

/// Converts equations of images to a measurement: information * scatter^-1 * information is the inverse
/// covariance of their motion (the sandwich of Huber 1967).
Matrix6d weighting(const tracking::ImageEquations& images) {
  const Matrix6d scatter = images.scatter + kLeastScatter * Matrix6d::Identity();
  return scatter.ldlt().solve(images.information).transpose() / kPixelsPerMeasurement;
}

Matrix6d pose_covariance(const filter::GaussianState& state) {
  return state.covariance.topLeftCorner<6, 6>() + kLeastVariance * Matrix6d::Identity();
}

}  // namespace

Result<void> InertialTracking::start(std::int64_t capture_ns) {
  auto state = prediction::initial_state(samples_, capture_ns, rig_, config_.terms, config_.initialisation,
                                         config_.self_calibration, std::nullopt);
  if (!state) return tl::unexpected(state.error());
  state_ = *state;
  capture_ns_ = capture_ns;
  return {};
}

Result<void> InertialTracking::predict(std::int64_t capture_ns) {
  auto state =
      prediction::predict_by_samples(state_, {capture_ns_, capture_ns}, samples_, rig_, config_.terms,
                                     config_.motion, config_.initialisation, config_.self_calibration);
  if (!state) return tl::unexpected(state.error());
  state_ = *state;
  capture_ns_ = capture_ns;
  return {};
}

InertialTracking::Term::Term(const InertialTracking& inertial, const SE3& T_world_view)
    : T_world_imu_(inertial.state_.mean.T_world_imu),
      T_world_view_(T_world_view),
      T_imu_camera_(inertial.rig_.T_imu_camera),
      prediction_information_(pose_covariance(inertial.state_).inverse()) {}

Vector6d InertialTracking::Term::step(const SE3& T_view_camera,
                                      const tracking::ImageEquations& images) const {
  const SE3 T_world_imu = T_world_view_ * T_view_camera * T_imu_camera_.inverse();
  const Matrix6d pose_by_step = step_by_pose(T_world_view_, T_view_camera, T_imu_camera_).inverse();
  const Matrix6d weight = weighting(images);
  const Matrix6d information =
      weight * images.information + pose_by_step.transpose() * prediction_information_ * pose_by_step;
  const Vector6d descent = weight * images.descent - pose_by_step.transpose() * prediction_information_ *
                                                         pose_minus(T_world_imu, T_world_imu_);
  return information.ldlt().solve(descent);
}

void InertialTracking::correct(const SE3& T_world_view, const SE3& T_view_camera,
                               const tracking::ImageEquations& images) {
  const SE3 T_world_imu = T_world_view * T_view_camera * rig_.T_imu_camera.inverse();
  const Matrix6d jacobian = step_by_pose(T_world_view, T_view_camera, rig_.T_imu_camera);
  const Matrix6d information = jacobian.transpose() * weighting(images) * images.information * jacobian;
  const Matrix6d covariance = pose_covariance(state_);
  const Eigen::Matrix<double, filter::kStateSize, 6> with_pose = state_.covariance.leftCols<6>();
  const Vector6d error = pose_minus(T_world_imu, state_.mean.T_world_imu);
  // The other states follow through their correlations.
  const filter::StateVector change = with_pose * covariance.ldlt().solve(error);
  // P - P H^T (H P H^T + R)^-1 H P, where R^-1 is the information, which may be singular.
  const Matrix6d gain = (Matrix6d::Identity() + information * covariance).fullPivLu().solve(information);
  state_.mean = filter::plus(state_.mean, change);
  state_.mean.T_world_imu = T_world_imu;
  state_.covariance = filter::symmetrised(state_.covariance - with_pose * gain * with_pose.transpose());
}

void InertialTracking::move_to(const SE3& T_world_camera) {
  const SE3 T_world_imu = T_world_camera * rig_.T_imu_camera.inverse();
  const Quaterniond turn = T_world_imu.rotation * state_.mean.T_world_imu.rotation.conjugate();
  state_.mean.T_world_imu = T_world_imu;
  state_.mean.velocity_world_mps = turn * state_.mean.velocity_world_mps;
  state_.mean.gravity_direction_world = (turn * state_.mean.gravity_direction_world).normalized();
}

}  // namespace fusebench::baselines::elasticfusion
