#include "core/estimator/places/relocalisation/relocalisation_update.hpp"

#include <gtest/gtest.h>

#include "core/estimator/filter/iekf.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "tests/support/large_matrices.hpp"

namespace fusebench {

using namespace filter;
using namespace relocalisation;

namespace {

const SE3 kPredicted{so3_exp({0.3, -0.2, 0.5}), {0.4, -0.3, 1.2}};
const SE3 kReference{so3_exp({0.2, -0.1, 0.4}), {0.5, -0.3, 1.1}};

/// A filter that has been without images for a while: the error of its position is that of its velocity.
GaussianState lost_at(const SE3& T_world_imu, double velocity_sigma_mps, double duration_s) {
  GaussianState state;
  state.mean.T_world_imu = T_world_imu;
  state.mean.T_world_imu_reference = {so3_exp({0.1, 0.1, 0.1}), {0.3, -0.2, 1.0}};
  state.mean.velocity_world_mps = {0.5, -0.2, 0.1};
  const double variance = velocity_sigma_mps * velocity_sigma_mps;
  for (int axis = 0; axis < 3; ++axis) {
    state.covariance(kRotation + axis, kRotation + axis) = 1e-4;
    state.covariance(kPosition + axis, kPosition + axis) = variance * duration_s * duration_s;
    state.covariance(kVelocity + axis, kVelocity + axis) = variance;
    state.covariance(kPosition + axis, kVelocity + axis) = variance * duration_s;
    state.covariance(kVelocity + axis, kPosition + axis) = variance * duration_s;
    state.covariance(kGyroscopeBias + axis, kGyroscopeBias + axis) = 1e-6;
  }
  return state;
}

RelocalisedPose place_at(const SE3& T_world_imu, double sigma) {
  RelocalisedPose place{T_world_imu, kReference};
  place.covariance = sigma * sigma * Matrix6d::Identity();
  place.reference_covariance = 1e-6 * Matrix6d::Identity();
  return place;
}

TEST(RelocalisationUpdate, AnExactPlaceIsAcceptedAndGivesTheVelocity) {
  Vector6d off;
  off << 0.005, -0.003, 0.004, 0.10, -0.05, 0.02;
  const SE3 found = pose_plus(kPredicted, off);
  const GaussianState state = relocalisation_update(lost_at(kPredicted, 0.2, 0.5), place_at(found, 1e-6), {});
  EXPECT_LT(pose_minus(state.mean.T_world_imu, found).norm(), 2e-3);  // possible error of the reference
  // The position was wrong because the velocity was, for half a second.
  EXPECT_LT((state.mean.velocity_world_mps - Vector3d(0.5, -0.2, 0.1) - off.tail<3>() / 0.5).norm(), 1e-4);
  EXPECT_EQ(state.mean.gyroscope_bias_radps, Vector3d::Zero());
}

TEST(RelocalisationUpdate, EqualsAKalmanUpdateWhereThePredictionIsHonest) {
  Vector6d off;
  off << 0.005, -0.003, 0.004, 0.02, -0.05, 0.02;  // well within the prediction's uncertainty
  const GaussianState prediction = lost_at(kPredicted, 0.2, 0.5);
  RelocalisedPose place = place_at(pose_plus(kPredicted, off), 0.01);
  place.reference_covariance.setZero();
  const GaussianState state = relocalisation_update(prediction, place, {});

  const Matrix6d P = prediction.covariance.topLeftCorner<kPoseSize, kPoseSize>();
  const Matrix6d expected(testing::kalman_gain(P, Matrix6d::Identity(), place.covariance));
  EXPECT_LT((pose_minus(state.mean.T_world_imu, kPredicted) - expected * off).norm(), 1e-12);
  const Matrix6d posterior = P - expected * P;
  // Up to the turn of the tangent by half a hundredth.
  const Matrix6d claimed = state.covariance.topLeftCorner<kPoseSize, kPoseSize>();
  EXPECT_LT((claimed - posterior).norm(), 0.01 * posterior.norm());
}

TEST(RelocalisationUpdate, ContradictionIsTheInnovationInStandardDeviations) {
  GaussianState prediction = lost_at(kPredicted, 0.2, 0.5);
  RelocalisedPose place = place_at(kPredicted, 0.01);
  place.reference_covariance.setZero();
  EXPECT_NEAR(normalised_innovation(prediction, place), 0.0, 1e-20);
  Vector6d off = Vector6d::Zero();
  off[4] = 0.3;  // of sigma 0.1 and 0.01
  place.T_world_imu = pose_plus(kPredicted, off);
  EXPECT_NEAR(normalised_innovation(prediction, place), 0.09 / (0.01 + 0.0001) / 6, 1e-9);
}

TEST(RelocalisationUpdate, AnErrorOfTheKeyframeHasALeverArm) {
  // The rotation of the keyframe about z is uncertain: 2 m along x from it, so is the position along y.
  GaussianState prediction = lost_at({}, 0.2, 0.5);
  RelocalisedPose place = place_at({Quaterniond::Identity(), Vector3d(2, 0, 0)}, 0.01);
  prediction.mean.T_world_imu = place.T_world_imu;
  place.T_world_imu_reference = SE3{};
  place.reference_covariance.setZero();
  place.reference_covariance(2, 2) = 0.05 * 0.05;
  const double position_variance = 0.1 * 0.1 + 0.01 * 0.01 + 2 * 2 * 0.05 * 0.05;
  EXPECT_NEAR(innovation_covariance(prediction, place)(4, 4), position_variance, 1e-9);
}

TEST(RelocalisationUpdate, AFilterThatWasTooSureOfItselfIsOverruled) {
  Vector6d off;
  off << 0.3, -0.2, 0.4, 2.0, -1.0, 0.5;  // tens of standard deviations
  const SE3 found = pose_plus(kPredicted, off);
  const GaussianState state =
      relocalisation_update(lost_at(kPredicted, 0.01, 0.5), place_at(found, 0.01), {});
  EXPECT_LT(pose_minus(state.mean.T_world_imu, found).norm(), 0.1);
  EXPECT_EQ(state.covariance(kGyroscopeBias, kGyroscopeBias), 1e-6);  // not contradicted by a place
  // The innovation is implausible, so the earlier velocity gives no information.
  EXPECT_EQ(state.mean.velocity_world_mps, Vector3d::Zero());
  EXPECT_NEAR(state.covariance(kVelocity, kVelocity), 1.0, 1e-12);
}

TEST(RelocalisationUpdate, ImagesAreComparedWithTheFrameOfThePlaceFromNowOn) {
  const RelocalisedPose place = place_at(kPredicted, 0.001);
  GaussianState lost = lost_at(kPredicted, 0.2, 0.5);
  lost.mean.reference_rate = Vector6d::Constant(2.0);  // of the frame that patches were cut from before
  const GaussianState state = relocalisation_update(lost, place, {});
  EXPECT_LT(pose_minus(state.mean.T_world_imu_reference, kReference).norm(), 1e-15);
  EXPECT_EQ(state.mean.reference_rate.norm(), 0);
  EXPECT_EQ(state.mean.reference_offset.norm(), 0);  // the place was where the filter thought
  // Against that frame the pose is as certain as the match, whatever the frame's own error.
  const Eigen::MatrixXd measured = testing::carried(measured_combinations(state.mean), state.covariance);
  const Matrix6d by_reference = measured.topLeftCorner<kPoseSize, kPoseSize>();
  EXPECT_LT(by_reference.trace(), place.covariance.trace());
  EXPECT_GT(by_reference.trace(), 0.9 * place.covariance.trace());
  // Against the model that error comes on top.
  const Matrix6d carried = pose_transport(kPredicted, kReference);
  const Matrix6d both = place.covariance + carried * place.reference_covariance * carried.transpose();
  const Matrix6d by_model = measured.block<kPoseSize, kPoseSize>(kPoseSize, kPoseSize);
  EXPECT_GT(by_model.trace(), 0.9 * both.trace());
  EXPECT_LT(by_model.trace(), both.trace());
  EXPECT_GE(testing::smallest_eigenvalue(state.covariance), -1e-15);
}

}  // namespace
}  // namespace fusebench
