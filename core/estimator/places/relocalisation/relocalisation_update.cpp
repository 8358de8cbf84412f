#include "core/estimator/places/relocalisation/relocalisation_update.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/solvers.hpp"
#include "core/estimator/filter/pose_clones.hpp"

namespace fusebench::relocalisation {

namespace {

/// Scales the standard deviations of the states that depend on the motion; biases and clock are unchanged.
filter::StateMatrix motion_inflated(const filter::StateMatrix& covariance, double factor) {
  filter::StateVector scale = filter::StateVector::Ones();
  for (const auto& [offset, size] : {std::pair{filter::kRotation, 9}, std::pair{filter::kGravity, 2},
                                     std::pair{filter::kAngularVelocity, 3}})
    scale.segment(offset, size).setConstant(factor);
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

/// Sets an independent prior for three components.
void reset_covariance(filter::StateMatrix& covariance, int offset, double sigma) {
  covariance.middleRows<3>(offset).setZero();
  covariance.middleCols<3>(offset).setZero();
  covariance.block<3, 3>(offset, offset).diagonal().setConstant(sigma * sigma);
}

/// Inflates the covariance of the prediction by the innovation.
filter::GaussianState inflated(const filter::GaussianState& prediction, double innovation,
                               const UnknownMotion& unknown) {
  filter::GaussianState state{prediction.mean,
                              motion_inflated(prediction.covariance, std::sqrt(std::max(1.0, innovation)))};
  if (innovation <= kInconsistentInnovation) return state;
  state.mean.velocity_world_mps.setZero();
  reset_covariance(state.covariance, filter::kVelocity, unknown.velocity_sigma_mps);
  if (unknown.angular_velocity_sigma_radps > 0) {
    state.mean.angular_velocity_imu_radps.setZero();
    reset_covariance(state.covariance, filter::kAngularVelocity, unknown.angular_velocity_sigma_radps);
  }
  return state;
}

/// Makes the keyframe the reference pose; its error is not correlated with the rest of the state.
filter::GaussianState with_reference_pose(const filter::GaussianState& state, const RelocalisedPose& place) {
  const Matrix6d carried =
      filter::pose_transport(place.T_world_imu_reference, state.mean.T_world_imu_reference);
  filter::StateMatrix refer = filter::StateMatrix::Identity();
  refer.middleRows<filter::kPoseSize>(filter::kReferencePose).setZero();
  refer.middleRows<filter::kPoseSize>(filter::kReferenceRate).setZero();
  refer.block<filter::kPoseSize, filter::kPoseSize>(filter::kModelPose, filter::kModelPose) = carried;
  refer.block<filter::kPoseSize, filter::kPoseSize>(filter::kModelRate, filter::kModelRate) = carried;
  filter::GaussianState result{state.mean, filter::symmetrised(refer * state.covariance * refer.transpose())};
  result.covariance.block<filter::kPoseSize, filter::kPoseSize>(
      filter::kReferencePose, filter::kReferencePose) = place.reference_covariance;
  result.mean.model_offset = carried * state.mean.model_offset;
  result.mean.model_rate_offset = carried * state.mean.model_rate_offset;
  result.mean.model_readout = filter::transported(carried, state.mean.model_readout);
  result.mean.T_world_imu_reference = place.T_world_imu_reference;
  // The motion at the keyframe is not stored, and that of another frame would be wrong.
  result.mean.reference_rate.setZero();
  result.mean.reference_offset.setZero();
  result.mean.reference_rate_offset.setZero();
  return result;
}

}  // namespace

Matrix6d innovation_covariance(const filter::GaussianState& prediction, const RelocalisedPose& place) {
  const Matrix6d carried = filter::pose_transport(place.T_world_imu, place.T_world_imu_reference);
  return prediction.covariance.topLeftCorner<filter::kPoseSize, filter::kPoseSize>() + place.covariance +
         carried * place.reference_covariance * carried.transpose();
}

double normalised_innovation(const filter::GaussianState& prediction, const RelocalisedPose& place) {
  const Vector6d innovation = pose_minus(place.T_world_imu, prediction.mean.T_world_imu);
  return innovation.dot(innovation_covariance(prediction, place).ldlt().solve(innovation)) /
         filter::kPoseSize;
}

filter::GaussianState relocalisation_update(const filter::GaussianState& prediction,
                                            const RelocalisedPose& place, const UnknownMotion& unknown) {
  const filter::GaussianState prior =
      with_reference_pose(inflated(prediction, normalised_innovation(prediction, place), unknown), place);
  // The match measures the pose relative to the keyframe, whatever the pose of the keyframe.
  Eigen::Matrix<double, filter::kPoseSize, filter::kStateSize> matched =
      Eigen::Matrix<double, filter::kPoseSize, filter::kStateSize>::Zero();
  matched.leftCols<filter::kPoseSize>().setIdentity();
  matched.block<filter::kPoseSize, filter::kPoseSize>(0, filter::kReferencePose) =
      -filter::pose_transport(place.T_world_imu, place.T_world_imu_reference);
  const Vector6d innovation = pose_minus(place.T_world_imu, prior.mean.T_world_imu);
  const Eigen::Matrix<double, filter::kStateSize, filter::kPoseSize> crossed =
      prior.covariance * matched.transpose();
  const Matrix6d expected = matched * crossed + place.covariance;
  const Eigen::Matrix<double, filter::kStateSize, filter::kPoseSize> gain =
      expected.ldlt().solve(crossed.transpose()).transpose();
  const filter::StateVector delta = gain * innovation;
  const filter::StateMatrix transport = filter::chart_transport(prior.mean, delta);
  const filter::StateMatrix covariance = prior.covariance - gain * crossed.transpose();
  return {filter::plus(prior.mean, delta),
          filter::symmetrised(transport * covariance * transport.transpose())};
}

}  // namespace fusebench::relocalisation
