#include "core/estimator/filter/pose_clones.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/config/groups/filter_config.hpp"
#include "core/estimator/filter/iekf.hpp"
#include "tests/support/known_measurement.hpp"
#include "tests/support/large_matrices.hpp"

namespace fusebench {

using namespace config;
using namespace filter;

namespace {

const SE3 kFrom{so3_exp({0.3, -0.2, 0.5}), {0.4, -0.3, 1.2}};
const SE3 kTo{so3_exp({-0.1, 0.6, 0.2}), {0.9, 0.2, 0.7}};

TEST(PoseClones, TransportEqualsTheErrorOfARigidlyAttachedPose) {
  Vector6d d;
  d << 1e-6, -2e-6, 3e-6, 4e-6, 5e-6, -6e-6;
  const SE3 displaced = pose_plus(kFrom, d);
  const SE3 T_from_to = kFrom.inverse() * kTo;
  EXPECT_LT((pose_minus(displaced * T_from_to, kTo) - pose_transport(kTo, kFrom) * d).norm(), 1e-10);
  EXPECT_LT((pose_transport(kFrom, kTo) * pose_transport(kTo, kFrom) - Matrix6d::Identity()).norm(), 1e-12);
}

GaussianState known_at(const SE3& T) {
  GaussianState state;
  state.mean.T_world_imu = state.mean.T_world_imu_reference = T;
  state.mean.velocity_world_mps = {0.5, -0.2, 0.1};
  return state;
}

/// A pose that errs by an amount in each direction, and nothing else.
GaussianState uncertain_at(const SE3& T, double variance) {
  GaussianState state = known_at(T);
  state.covariance.topLeftCorner<kPoseSize, kPoseSize>().diagonal().setConstant(variance);
  return state;
}

/// A frame that is fused, and that the next patches are cut from.
GaussianState cut_and_fused(const GaussianState& state, const ModelDrift& drift,
                            const CompensatedReadout& compensated = {}) {
  return cloned_as_reference(fused_into_model(state, drift, compensated), compensated);
}

TEST(PoseClones, AnAnchorGainsTheErrorOfItsOwnImage) {
  // With both halves of the noise of a difference, the first frame against a new anchor is as uncertain as
  // with the whole of it; a second one shares the anchor's half.
  GaussianState state = known_at(kTo);
  const Matrix6d whole = 25.0 * Matrix6d::Identity();
  const GaussianState anchored = with_anchor_noise(state, 1e12 * 2 * whole);
  const auto reference = anchored.covariance.block<kPoseSize, kPoseSize>(kReferencePose, kReferencePose);
  EXPECT_LT((2e12 * reference - whole.inverse()).norm(), 1e-6);
  EXPECT_EQ((anchored.covariance - state.covariance).topRows<kReferencePose>().norm(), 0);
  // Directions without information stay within 0.01 rad and 0.1 m.
  const GaussianState blind = with_anchor_noise(state, Matrix6d::Zero());
  const auto widest = blind.covariance.block<kPoseSize, kPoseSize>(kReferencePose, kReferencePose);
  EXPECT_NEAR(std::sqrt(widest(0, 0)), 0.01, 1e-12);
  EXPECT_NEAR(std::sqrt(widest(5, 5)), 0.1, 1e-12);
}

TEST(PoseClones, ErrorsTakenOverByTheModelStayErrorsInTheWorld) {
  const GaussianState before = uncertain_at(kTo, 1e-4);
  for (const double share : {0.0, 0.3, 1.0}) {
    const GaussianState after = cut_and_fused(before, {.share = share});
    const Matrix6d against_model = after.covariance.topLeftCorner<kPoseSize, kPoseSize>();
    EXPECT_LT((against_model - (1 - share) * (1 - share) * 1e-4 * Matrix6d::Identity()).norm(), 1e-15);
    const Matrix6d in_world = in_first_camera_world(after).covariance.topLeftCorner<kPoseSize, kPoseSize>();
    EXPECT_LT((in_world - 1e-4 * Matrix6d::Identity()).norm(), 1e-15) << share;
  }
}

TEST(PoseClones, AnAnchoredFrameGivesNoInformationAgainstItself) {
  const GaussianState state = cut_and_fused(uncertain_at(kTo, 1e-4), {});
  const Eigen::MatrixXd measured = testing::carried(measured_combinations(state.mean), state.covariance);
  EXPECT_LT(measured.topLeftCorner(kPoseSize, kPoseSize).norm(), 1e-15);
  EXPECT_NEAR(measured.block(kPoseSize, kPoseSize, kPoseSize, kPoseSize).trace(), 6e-4, 1e-12);
}

/// Noisy steps of a camera at rest: against the last frame alone its error grows like a random walk, against
/// the model it is bounded. The covariance of the filter must agree with both.
TEST(PoseClones, CovarianceGrowsWithErrorsOfRelativeMeasurements) {
  constexpr int kRuns = 40, kSteps = 50;
  constexpr double kSigma = 1e-3;
  for (const bool by_model : {false, true}) {
    double squared = 0, claimed = 0;
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0.0, kSigma);
    for (int run = 0; run < kRuns; ++run) {
      GaussianState state = cut_and_fused(known_at(SE3{}), {});
      SE3 reference_truth;  // true pose of the reference frame
      for (int step = 0; step < kSteps; ++step) {
        state.covariance.topLeftCorner<kPoseSize, kPoseSize>() += Matrix6d::Identity();  // it may have moved
        Vector6d noise;
        for (int i = 0; i < kPoseSize; ++i) noise[i] = normal(random);
        // The true pose is the identity; the patches were cut at the estimate.
        const SE3 seen = pose_plus(state.mean.T_world_imu_reference * reference_truth.inverse(), noise);
        KnownMeasurement measurement(seen, pose_plus(SE3{}, noise), by_model ? 0.0 : kSigma,
                                     by_model ? kSigma : 0.0);
        state = cut_and_fused(iekf_update(state, measurement, IekfConfig{}).posterior, {});
      }
      squared += state.mean.T_world_imu.translation.squaredNorm() / kRuns;
      claimed = in_first_camera_world(state).covariance.block<3, 3>(kPosition, kPosition).trace();
    }
    const double expected = 3 * kSigma * kSigma * (by_model ? 1 : kSteps);
    EXPECT_NEAR(claimed / expected, 1.0, 0.02) << by_model;
    EXPECT_GT(squared / expected, 0.7) << by_model;
    EXPECT_LT(squared / expected, 1.4) << by_model;
  }
}

TEST(PoseClones, ASecondLookFromTheSameReferenceIsNoMotion) {
  // Without an anchor in between (an occluded frame is tracked, but nothing is cut from it) the next frame is
  // compared with the same patches: what was learnt of the reference pose must not count as motion.
  GaussianState state = cut_and_fused(uncertain_at(kTo, 1e-6), {});
  state.covariance.topLeftCorner<kPoseSize, kPoseSize>() += 1e-4 * Matrix6d::Identity();
  Vector6d off;
  off << 2e-4, -1e-4, 3e-4, 1e-3, -2e-3, 1e-3;
  const SE3 by_model = pose_plus(kTo, off);
  KnownMeasurement first(kTo, by_model, 1e-3, 1e-3);
  state = iekf_update(state, first, IekfConfig{}).posterior;
  EXPECT_GT(state.mean.reference_offset.norm(), 1e-6);

  // The camera is at rest, and the second image gives exactly the measurement of the first.
  KnownMeasurement second(kTo, by_model, 1e-3, 1e-3);
  GaussianState again = iekf_update(state, second, IekfConfig{}).posterior;
  GaussianState once = cut_and_fused(uncertain_at(kTo, 1e-6), {});
  once.covariance.topLeftCorner<kPoseSize, kPoseSize>() += 1e-4 * Matrix6d::Identity();
  KnownMeasurement both(kTo, by_model, 1e-3 / std::sqrt(2.0), 1e-3 / std::sqrt(2.0));
  once = iekf_update(once, both, IekfConfig{}).posterior;
  EXPECT_LT(pose_minus(again.mean.T_world_imu, once.mean.T_world_imu).norm(), 1e-7);
  EXPECT_LT(testing::relative_distance(again.covariance, once.covariance), 1e-3);
}

TEST(PoseClones, AReferenceThatIsKeptMovesWithTheModel) {
  // The patches keep the frame at kFrom while frames at kTo are fused. The measurement by colour and the pose
  // of the reference in the first camera frame do not change with a fusion.
  GaussianState state = cloned_as_reference(uncertain_at(kFrom, 1e-4));
  state.mean.T_world_imu = kTo;
  state.covariance.topLeftCorner<kPoseSize, kPoseSize>() += 1e-5 * Matrix6d::Identity();
  const GaussianState after = fused_into_model(state, {.share = 0.3});
  const auto against_reference = [](const GaussianState& at) -> Eigen::MatrixXd {
    return testing::carried(measured_combinations(at.mean), at.covariance)
        .topLeftCorner(kPoseSize, kPoseSize);
  };
  EXPECT_LT(testing::relative_distance(against_reference(after), against_reference(state)), 1e-9);
  const auto reference_in_world = [](const GaussianState& at) -> Matrix6d {
    return in_first_camera_world(at).covariance.block<kPoseSize, kPoseSize>(kReferencePose, kReferencePose);
  };
  EXPECT_LT(testing::relative_distance(reference_in_world(after), reference_in_world(state)), 1e-9);
}

TEST(PoseClones, DriftBeyondIndependentErrorsIsNoErrorOfThePose) {
  const GaussianState before = uncertain_at(kTo, 1e-4);
  const GaussianState after = cut_and_fused(before, {.share = 0.1, .factor = 5});
  EXPECT_NEAR(after.covariance(kPosition, kPosition), 0.81e-4, 1e-12);
  EXPECT_NEAR(after.covariance(kModelPose, kModelPose), 0.01e-4 * 25, 1e-12);
  EXPECT_NEAR(after.covariance(kModelPose + 3, kModelPose + 3), 0.01e-4 * 25, 1e-12);
  EXPECT_NEAR(after.covariance(kPosition, kModelPose + 3), 0.9 * 0.1 * 1e-4, 1e-12);
}

TEST(PoseClones, EqualDistortionsGiveNoInformationOnTheMotion) {
  // At the first fusion the whole model has the distortion of the frame; later ones average it away.
  GaussianState state = known_at(kTo);
  state.covariance.block<3, 3>(kAngularVelocity, kAngularVelocity) = 4.0 * Matrix3d::Identity();
  state.covariance.block<3, 3>(kVelocity, kVelocity) = 0.25 * Matrix3d::Identity();
  GaussianState fused = cut_and_fused(state, {.share = 1});
  const auto rates = [&]() -> Eigen::VectorXd {
    return testing::carried(measured_combinations(fused.mean), fused.covariance)
        .diagonal()
        .tail(2 * kPoseSize);
  };
  EXPECT_LT(rates().norm(), 1e-12);
  fused = cut_and_fused(fused, {.share = 0.25});
  EXPECT_LT(rates().head(kPoseSize).norm(), 1e-12);  // the reference is the last frame

  // The motion is another one now: the model shows a quarter of its error.
  Eigen::MatrixXd covariance = fused.covariance;
  covariance.middleRows(kAngularVelocity, 3).setZero();
  covariance.middleCols(kAngularVelocity, 3).setZero();
  covariance.middleRows(kModelRate, kPoseSize).setZero();
  covariance.middleCols(kModelRate, kPoseSize).setZero();
  fused.covariance = covariance;
  fused.covariance.block<3, 3>(kAngularVelocity, kAngularVelocity) = 4.0 * Matrix3d::Identity();
  fused.mean.model_rate_offset << 0.4, 0, 0, 0, 0, 0.2;
  const GaussianState next = cut_and_fused(fused, {.share = 0.25});
  EXPECT_NEAR(next.covariance(kModelRate, kModelRate), 0.0625 * 4, 1e-12);
  EXPECT_NEAR(next.covariance(kModelRate, kAngularVelocity), 0.25 * 4, 1e-12);
  const Matrix6d carried = pose_transport(fused.mean.T_world_imu, fused.mean.T_world_imu_reference);
  EXPECT_LT((next.mean.model_rate_offset - 0.75 * carried * fused.mean.model_rate_offset).norm(), 1e-12);
  EXPECT_EQ(next.mean.reference_rate_offset.norm(), 0.0);
}

TEST(PoseClones, TheModelKeepsTheReadoutThatWasCompensatedInItsFrames) {
  CompensatedReadout compensated;
  compensated.rate << 0.4, -0.2, 0.1, 0.3, 0.5, -0.6;
  compensated.timing_s = {0.021, 0.03, -0.01};
  const GaussianState first = cut_and_fused(known_at(kTo), {.share = 1}, compensated);
  EXPECT_LT((first.mean.model_readout.rate - compensated.rate).norm(), 1e-15);
  EXPECT_LT((first.mean.model_readout.by_readout - 0.03 * compensated.rate).norm(), 1e-15);
  EXPECT_LT((first.mean.model_readout.by_delay + 0.01 * compensated.rate).norm(), 1e-15);
  EXPECT_EQ(first.mean.reference_color_readout_s, 0.021);
  // A frame at rest averages half of it away.
  const GaussianState second = cut_and_fused(first, {.share = 0.5});
  EXPECT_LT((second.mean.model_readout.rate - 0.5 * compensated.rate).norm(), 1e-15);
  EXPECT_LT((second.mean.model_readout.by_readout - 0.015 * compensated.rate).norm(), 1e-15);
  EXPECT_EQ(second.mean.reference_color_readout_s, 0.0);
}

TEST(PoseClones, ADisplacedModelTurnsVelocityAndGravity) {
  // The model is rotated by a small angle about the pose; quantities relative to it are rotated in the world.
  GaussianState state = known_at(kTo);
  state.mean.gravity_direction_world = Vector3d(0.2, 0.9, -0.4).normalized();
  const double sigma = 1e-3;
  state.covariance(kModelPose + 1, kModelPose + 1) = sigma * sigma;
  const StateMatrix world = in_first_camera_world(state).covariance;
  const Vector3d axis = state.mean.T_world_imu.rotation * Vector3d::UnitY();
  const Vector3d by_turn = axis.cross(state.mean.velocity_world_mps);
  EXPECT_LT((world.block<3, 3>(kVelocity, kVelocity) - sigma * sigma * by_turn * by_turn.transpose()).norm(),
            1e-12);
  const Vector2d tilt = s2_minus(so3_exp(1e-6 * axis) * state.mean.gravity_direction_world,
                                 state.mean.gravity_direction_world) /
                        1e-6;
  EXPECT_LT((world.block<2, 2>(kGravity, kGravity) - sigma * sigma * tilt * tilt.transpose()).norm(), 1e-11);
}

}  // namespace
}  // namespace fusebench
