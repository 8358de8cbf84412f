#include "core/estimator/filter/moved_state.hpp"

namespace fusebench::filter {

namespace {

/// Rotates a tangent of the pose: only the position part is in world axes.
Vector6d turned(const Quaterniond& R_new_old, const Vector6d& tangent) {
  Vector6d result = tangent;
  result.tail<3>() = R_new_old * tangent.tail<3>();
  return result;
}

}  // namespace

FilterState moved(const FilterState& state, const SE3& T_new_old) {
  const Quaterniond& R = T_new_old.rotation;
  FilterState result = state;
  result.T_world_imu = T_new_old * state.T_world_imu;
  result.velocity_world_mps = R * state.velocity_world_mps;
  result.gravity_direction_world = (R * state.gravity_direction_world).normalized();
  result.T_world_imu_reference = T_new_old * state.T_world_imu_reference;
  result.reference_rate = turned(R, state.reference_rate);
  result.reference_offset = turned(R, state.reference_offset);
  result.model_offset = turned(R, state.model_offset);
  result.reference_rate_offset = turned(R, state.reference_rate_offset);
  result.model_rate_offset = turned(R, state.model_rate_offset);
  result.model_readout = {turned(R, state.model_readout.rate), turned(R, state.model_readout.by_readout),
                          turned(R, state.model_readout.by_delay)};
  return result;
}

GaussianState moved(const GaussianState& state, const SE3& T_new_old) {
  GaussianState result{moved(state.mean, T_new_old), {}};
  const Matrix3d R = T_new_old.rotation_matrix();
  StateMatrix turn = StateMatrix::Identity();
  for (const int position :
       {+kPosition, +kVelocity, kReferencePose + 3, kModelPose + 3, kReferenceRate + 3, kModelRate + 3})
    turn.block<3, 3>(position, position) = R;
  turn.block<2, 2>(kGravity, kGravity) = s2_basis(result.mean.gravity_direction_world).transpose() * R *
                                         s2_basis(state.mean.gravity_direction_world);
  result.covariance = symmetrised(turn * state.covariance * turn.transpose());
  return result;
}

}  // namespace fusebench::filter
