#include "core/estimator/filter/moved_state.hpp"

#include <gtest/gtest.h>

#include "core/estimator/filter/pose_clones.hpp"
#include "tests/support/large_matrices.hpp"
#include "tests/support/numeric_jacobian.hpp"

namespace fusebench {

using namespace filter;

namespace {

const SE3 kMove{so3_exp({0.2, -0.4, 0.3}), {1, -2, 0.5}};

FilterState state() {
  FilterState state;
  state.T_world_imu = {so3_exp({0.1, 0.5, -0.2}), {0.3, 0.2, -0.7}};
  state.velocity_world_mps = {0.4, -0.1, 0.2};
  state.gravity_direction_world = Vector3d(0.1, 0.9, -0.2).normalized();
  state.angular_velocity_imu_radps = {0.5, 1, -0.3};
  state.T_world_imu_reference = {so3_exp({0.1, 0.45, -0.2}), {0.3, 0.15, -0.7}};
  state.reference_rate << 0.4, 1.1, -0.2, 0.3, 0, 0.1;
  state.model_offset << 0.01, 0, 0.02, 0.03, -0.01, 0;
  return state;
}

/// Numeric: a small error before and after the move.
TEST(MovedState, CovarianceTurnsAsErrorsDo) {
  GaussianState before{state(), StateMatrix::Identity()};
  for (int i = 0; i < kStateSize; ++i) before.covariance(i, i) = 1 + i;
  const FilterState mean = moved(before.mean, kMove);
  const Eigen::MatrixXd turn = testing::numeric_jacobian(
      [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
        return minus(moved(plus(before.mean, StateVector(e)), kMove), mean);
      },
      kStateSize);
  const Eigen::MatrixXd expected = testing::carried(turn, before.covariance);
  EXPECT_LT(testing::largest_difference(moved(before, kMove).covariance, expected), 1e-3);
}

TEST(MovedState, ThereAndBackIsTheSame) {
  const FilterState back = moved(moved(state(), kMove), kMove.inverse());
  EXPECT_LT(testing::distance(minus(back, state()), StateVector::Zero()), 1e-12);
  EXPECT_LT(pose_minus(back.T_world_imu_reference, state().T_world_imu_reference).norm(), 1e-12);
  EXPECT_LT((back.reference_rate - state().reference_rate).norm(), 1e-12);
}

/// Image measurements are relative to the reference and to the model, which move too.
TEST(MovedState, MeasurementsStayAsTheyAre) {
  GaussianState before{state(), StateMatrix::Identity()};
  for (int i = 0; i < kStateSize; ++i) before.covariance(i, i) = 1 + i;
  const GaussianState after = moved(before, kMove);
  const Eigen::MatrixXd variances_before =
      testing::carried(measured_combinations(before.mean), before.covariance);
  const Eigen::MatrixXd variances_after =
      testing::carried(measured_combinations(after.mean), after.covariance);
  // Rotations are in the axes of the IMU, positions in those of the world.
  EXPECT_NEAR(variances_before.topLeftCorner(3, 3).trace(), variances_after.topLeftCorner(3, 3).trace(),
              1e-9);
  EXPECT_NEAR(variances_before.block(3, 3, 3, 3).trace(), variances_after.block(3, 3, 3, 3).trace(), 1e-9);
  EXPECT_NEAR(variances_before.block(9, 9, 3, 3).trace(), variances_after.block(9, 9, 3, 3).trace(), 1e-9);
}

}  // namespace
}  // namespace fusebench
