#include "core/resumption.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/pose_anchors.hpp"

namespace fusebench {

namespace {

/// Standard deviations of all that follows from the motion, times a factor; biases and the clock stay
/// as they are.
StateMatrix motion_inflated(const StateMatrix& covariance, double factor) {
  StateVector scale = StateVector::Ones();
  for (const auto& [offset, size] :
       {std::pair{kRotation, 9}, std::pair{kGravity, 2}, std::pair{kAngularVelocity, 3}})
    scale.segment(offset, size).setConstant(factor);
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

/// Of the found pose against the model.
Matrix6d place_noise(const RecognisedPlace& place) {
  const Matrix6d carried = pose_transport(place.T_world_imu, place.T_world_imu_reference);
  return place.covariance + carried * place.reference_covariance * carried.transpose();
}

}  // namespace

double contradiction(const GaussianState& prediction, const RecognisedPlace& place) {
  const Vector6d innovation = pose_minus(place.T_world_imu, prediction.mean.T_world_imu);
  const Matrix6d expected = prediction.covariance.topLeftCorner<kPoseSize, kPoseSize>() + place_noise(place);
  return innovation.dot(expected.ldlt().solve(innovation)) / kPoseSize;
}

GaussianState resumed(const GaussianState& prediction, const RecognisedPlace& place) {
  const Vector6d innovation = pose_minus(place.T_world_imu, prediction.mean.T_world_imu);
  const double factor = std::sqrt(std::max(1.0, contradiction(prediction, place)));
  const StateMatrix covariance = motion_inflated(prediction.covariance, factor);

  const Eigen::Matrix<double, kStateSize, kPoseSize> crossed = covariance.leftCols<kPoseSize>();
  const Matrix6d expected = crossed.topRows<kPoseSize>() + place_noise(place);
  const Eigen::Matrix<double, kStateSize, kPoseSize> gain =
      expected.ldlt().solve(crossed.transpose()).transpose();
  const StateVector delta = gain * innovation;
  GaussianState result{plus(prediction.mean, delta), covariance - gain * crossed.transpose()};

  // The patches are of another frame now: its error is told by nothing else in the state.
  StateMatrix anchor = chart_transport(prediction.mean, delta);
  anchor.middleRows<kPoseSize>(kReferencePose).setZero();
  const Matrix6d carried = pose_transport(place.T_world_imu_reference, prediction.mean.T_world_imu_reference);
  anchor.block<kPoseSize, kPoseSize>(kModelPose, kModelPose) = carried;
  result.covariance = anchor * result.covariance * anchor.transpose();
  result.covariance.block<kPoseSize, kPoseSize>(kReferencePose, kReferencePose) = place.reference_covariance;
  result.covariance = symmetrised(result.covariance);
  result.mean.model_offset = carried * result.mean.model_offset;
  result.mean.T_world_imu_reference = place.T_world_imu_reference;
  result.mean.reference_offset.setZero();
  return result;
}

}  // namespace fusebench
