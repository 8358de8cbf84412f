#include "core/relocalisation_update.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/pose_anchors.hpp"

namespace fusebench {

namespace {

/// Standard deviations of all that follows from the motion, times a factor; biases and the clock stay as they
/// are.
StateMatrix motion_inflated(const StateMatrix& covariance, double factor) {
  StateVector scale = StateVector::Ones();
  for (const auto& [offset, size] :
       {std::pair{kRotation, 9}, std::pair{kGravity, 2}, std::pair{kAngularVelocity, 3}})
    scale.segment(offset, size).setConstant(factor);
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

/// Three components get a prior of their own, uncorrelated with the rest.
void reset_covariance(StateMatrix& covariance, int offset, double sigma) {
  covariance.middleRows<3>(offset).setZero();
  covariance.middleCols<3>(offset).setZero();
  covariance.block<3, 3>(offset, offset).diagonal().setConstant(sigma * sigma);
}

/// The prediction with its covariance inflated by the innovation.
GaussianState inflated(const GaussianState& prediction, double innovation, const UnknownMotion& unknown) {
  GaussianState state{prediction.mean,
                      motion_inflated(prediction.covariance, std::sqrt(std::max(1.0, innovation)))};
  if (innovation <= kInconsistentInnovation) return state;
  state.mean.velocity_world_mps.setZero();
  reset_covariance(state.covariance, kVelocity, unknown.velocity_sigma_mps);
  if (unknown.angular_velocity_sigma_radps > 0) {
    state.mean.angular_velocity_imu_radps.setZero();
    reset_covariance(state.covariance, kAngularVelocity, unknown.angular_velocity_sigma_radps);
  }
  return state;
}

/// The keyframe becomes the reference pose; its error is not correlated with the rest of the state.
GaussianState with_reference_pose(const GaussianState& state, const RelocalisedPose& place) {
  const Matrix6d carried = pose_transport(place.T_world_imu_reference, state.mean.T_world_imu_reference);
  StateMatrix refer = StateMatrix::Identity();
  refer.middleRows<kPoseSize>(kReferencePose).setZero();
  refer.block<kPoseSize, kPoseSize>(kModelPose, kModelPose) = carried;
  GaussianState result{state.mean, symmetrised(refer * state.covariance * refer.transpose())};
  result.covariance.block<kPoseSize, kPoseSize>(kReferencePose, kReferencePose) = place.reference_covariance;
  result.mean.model_offset = carried * state.mean.model_offset;
  result.mean.T_world_imu_reference = place.T_world_imu_reference;
  result.mean.reference_offset.setZero();
  return result;
}

}  // namespace

double normalised_innovation(const GaussianState& prediction, const RelocalisedPose& place) {
  const Matrix6d carried = pose_transport(place.T_world_imu, place.T_world_imu_reference);
  const Matrix6d expected = prediction.covariance.topLeftCorner<kPoseSize, kPoseSize>() + place.covariance +
                            carried * place.reference_covariance * carried.transpose();
  const Vector6d innovation = pose_minus(place.T_world_imu, prediction.mean.T_world_imu);
  return innovation.dot(expected.ldlt().solve(innovation)) / kPoseSize;
}

GaussianState relocalisation_update(const GaussianState& prediction, const RelocalisedPose& place,
                                    const UnknownMotion& unknown) {
  const GaussianState prior =
      with_reference_pose(inflated(prediction, normalised_innovation(prediction, place), unknown), place);
  // The match tells the pose against that frame, wherever the frame is.
  Eigen::Matrix<double, kPoseSize, kStateSize> matched = Eigen::Matrix<double, kPoseSize, kStateSize>::Zero();
  matched.leftCols<kPoseSize>().setIdentity();
  matched.block<kPoseSize, kPoseSize>(0, kReferencePose) =
      -pose_transport(place.T_world_imu, place.T_world_imu_reference);
  const Vector6d innovation = pose_minus(place.T_world_imu, prior.mean.T_world_imu);
  const Eigen::Matrix<double, kStateSize, kPoseSize> crossed = prior.covariance * matched.transpose();
  const Matrix6d expected = matched * crossed + place.covariance;
  const Eigen::Matrix<double, kStateSize, kPoseSize> gain =
      expected.ldlt().solve(crossed.transpose()).transpose();
  const StateVector delta = gain * innovation;
  const StateMatrix transport = chart_transport(prior.mean, delta);
  const StateMatrix covariance = prior.covariance - gain * crossed.transpose();
  return {plus(prior.mean, delta), symmetrised(transport * covariance * transport.transpose())};
}

}  // namespace fusebench
