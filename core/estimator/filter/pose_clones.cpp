#include "core/estimator/filter/pose_clones.hpp"

#include <algorithm>
#include <utility>

namespace fusebench::filter {

namespace {

/// Jacobian of the error state with respect to a rigid displacement of the reference frame, given as a pose
/// error at the pose. Quantities expressed in the displaced frame move in the opposite direction.
Eigen::Matrix<double, kStateSize, kPoseSize> displacement(const FilterState& state) {
  Eigen::Matrix<double, kStateSize, kPoseSize> moves = Eigen::Matrix<double, kStateSize, kPoseSize>::Zero();
  const Matrix3d R = state.T_world_imu.rotation_matrix();
  moves.topRows<kPoseSize>().setIdentity();
  // A rotation error phi of the body is R phi in the world frame.
  moves.block<3, 3>(kVelocity, 0) = -hat(state.velocity_world_mps) * R;
  moves.block<2, 3>(kGravity, 0) = s2_basis(state.gravity_direction_world).transpose() * R;
  moves.middleRows<kPoseSize>(kReferencePose) =
      pose_transport(state.T_world_imu_reference, state.T_world_imu);
  moves.block<3, 3>(kReferenceRate + 3, 0) = -hat(state.reference_rate.tail<3>()) * R;
  return moves;
}

/// Sets six rows, from `row` on, to a share of the errors of pose_rate().
void take_rate(auto& rows, int row, double share) {
  rows.template block<3, 3>(row, kAngularVelocity).diagonal().setConstant(share);
  rows.template block<3, 3>(row + 3, kVelocity).diagonal().setConstant(share);
}

GaussianState transformed(const GaussianState& state, const StateMatrix& by) {
  return {state.mean, symmetrised(by * state.covariance * by.transpose())};
}

/// Both arguments are given at the pose of the frame.
FusedReadout fused(const FusedReadout& model, const CompensatedReadout& frame, double share) {
  const auto mixed = [&](const Vector6d& before, const Vector6d& now) -> Vector6d {
    return (1 - share) * before + share * now;
  };
  return {mixed(model.rate, frame.rate),
          mixed(model.by_readout, frame.timing_s[kDepthReadout - kColorReadout] * frame.rate),
          mixed(model.by_delay, frame.timing_s[kDepthDelay - kColorReadout] * frame.rate)};
}

}  // namespace

Matrix6d pose_transport(const SE3& to, const SE3& from) {
  Matrix6d transport = Matrix6d::Identity();
  const Matrix3d R_from = from.rotation_matrix();
  transport.topLeftCorner<3, 3>() = to.rotation_matrix().transpose() * R_from;
  transport.bottomLeftCorner<3, 3>() = -hat(to.translation - from.translation) * R_from;
  return transport;
}

FusedReadout transported(const Matrix6d& transport, const FusedReadout& readout) {
  return {transport * readout.rate, transport * readout.by_readout, transport * readout.by_delay};
}

Eigen::Matrix<double, kMeasuredSize, kStateSize> measured_combinations(const FilterState& state) {
  Eigen::Matrix<double, kMeasuredSize, kStateSize> rows =
      Eigen::Matrix<double, kMeasuredSize, kStateSize>::Zero();
  const Matrix6d carried = pose_transport(state.T_world_imu, state.T_world_imu_reference);
  rows.topLeftCorner<kPoseSize, kPoseSize>().setIdentity();
  rows.block<kPoseSize, kPoseSize>(0, kReferencePose) = -carried;
  rows.block<kPoseSize, kPoseSize>(kPoseSize, 0).setIdentity();
  rows.block<kTimingSize, kTimingSize>(2 * kPoseSize, kColorReadout).setIdentity();
  constexpr int kRates = kMeasuredSize - 2 * kPoseSize;
  for (const auto& [row, clone] : {std::pair{kRates, kReferenceRate}, {kRates + kPoseSize, kModelRate}}) {
    take_rate(rows, row, 1);
    rows.block<kPoseSize, kPoseSize>(row, clone) = -carried;
  }
  return rows;
}

GaussianState fused_into_model(const GaussianState& state, const ModelDrift& drift,
                               const CompensatedReadout& compensated) {
  const Matrix6d to_reference = pose_transport(state.mean.T_world_imu_reference, state.mean.T_world_imu);
  StateMatrix to_model = StateMatrix::Identity();
  to_model.leftCols<kPoseSize>() -= drift.share * displacement(state.mean);
  to_model.block<kPoseSize, kPoseSize>(kModelPose, 0) = drift.share * to_reference;
  Eigen::Matrix<double, kPoseSize, kStateSize> rate = Eigen::Matrix<double, kPoseSize, kStateSize>::Zero();
  take_rate(rate, 0, drift.share);
  to_model.middleRows<kPoseSize>(kModelRate) = to_reference * rate;
  to_model.block<kPoseSize, kPoseSize>(kModelRate, kModelRate).diagonal().setConstant(1 - drift.share);

  GaussianState result = transformed(state, to_model);
  // Drift of the model above that of independent errors is not an error of this pose.
  const double excess = drift.share * drift.share * std::max(0.0, drift.factor * drift.factor - 1.0);
  result.covariance.block<kPoseSize, kPoseSize>(kModelPose, kModelPose) +=
      excess * to_reference * state.covariance.topLeftCorner<kPoseSize, kPoseSize>() *
      to_reference.transpose();
  result.mean.model_rate_offset =
      (1 - drift.share) * state.mean.model_rate_offset + drift.share * to_reference * compensated.rate_left;
  CompensatedReadout at_reference = compensated;
  at_reference.rate = to_reference * compensated.rate;
  result.mean.model_readout = fused(state.mean.model_readout, at_reference, drift.share);
  return result;
}

GaussianState cloned_as_reference(const GaussianState& state, const CompensatedReadout& compensated) {
  const Matrix6d carried = pose_transport(state.mean.T_world_imu, state.mean.T_world_imu_reference);
  StateMatrix clone = StateMatrix::Identity();
  clone.block<kPoseSize, kPoseSize>(kModelPose, kModelPose) = carried;
  clone.block<kPoseSize, kPoseSize>(kModelRate, kModelRate) = carried;
  clone.middleRows<kPoseSize>(kReferencePose).setZero();
  clone.block<kPoseSize, kPoseSize>(kReferencePose, 0).setIdentity();
  clone.middleRows<kPoseSize>(kReferenceRate).setZero();
  take_rate(clone, kReferenceRate, 1);

  GaussianState result = transformed(state, clone);
  result.mean.model_offset = carried * state.mean.model_offset;
  result.mean.model_rate_offset = carried * state.mean.model_rate_offset;
  result.mean.model_readout = transported(carried, state.mean.model_readout);
  result.mean.T_world_imu_reference = state.mean.T_world_imu;
  result.mean.reference_rate = pose_rate(state.mean);
  result.mean.reference_offset.setZero();
  result.mean.reference_rate_offset = compensated.rate_left;
  result.mean.reference_color_readout_s = compensated.timing_s[0];
  return result;
}

GaussianState with_reference_noise(GaussianState state, const ReferenceNoise& noise) {
  auto variances = state.covariance.diagonal().segment<kPoseSize>(kReferencePose).array();
  variances.head<3>() += noise.rotation_rad * noise.rotation_rad;
  variances.tail<3>() += noise.translation_m * noise.translation_m;
  return state;
}

GaussianState with_anchor_noise(GaussianState state, const Matrix6d& information) {
  constexpr double kWidest_rad = 0.01;
  constexpr double kWidest_m = 0.1;
  Vector6d limits;
  limits << Vector3d::Constant(1 / (kWidest_rad * kWidest_rad)),
      Vector3d::Constant(1 / (kWidest_m * kWidest_m));
  const Matrix6d limited = information + Matrix6d(limits.asDiagonal());
  const Matrix6d covariance = limited.inverse();
  state.covariance.block<kPoseSize, kPoseSize>(kReferencePose, kReferencePose) +=
      0.5 * (covariance + covariance.transpose());
  return state;
}

GaussianState with_model_of(const GaussianState& state, const GaussianState& there) {
  GaussianState result = state;
  const Matrix6d carried = pose_transport(state.mean.T_world_imu_reference, there.mean.T_world_imu_reference);
  result.mean.model_offset = carried * there.mean.model_offset;
  result.mean.model_rate_offset = carried * there.mean.model_rate_offset;
  result.mean.model_readout = transported(carried, there.mean.model_readout);
  for (const int offset : {+kModelPose, +kModelRate}) {
    result.covariance.middleRows<kPoseSize>(offset).setZero();
    result.covariance.middleCols<kPoseSize>(offset).setZero();
    result.covariance.block<kPoseSize, kPoseSize>(offset, offset) =
        carried * there.covariance.block<kPoseSize, kPoseSize>(offset, offset) * carried.transpose();
  }
  return result;
}

GaussianState in_first_camera_world(const GaussianState& state) {
  const Matrix6d carried = pose_transport(state.mean.T_world_imu, state.mean.T_world_imu_reference);
  StateMatrix to_world = StateMatrix::Identity();
  to_world.middleCols<kPoseSize>(kModelPose) += displacement(state.mean) * carried;
  return transformed(state, to_world);
}

}  // namespace fusebench::filter
