#include "core/estimator/filter/filter_state.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/large_matrices.hpp"
#include "tests/support/numeric_jacobian.hpp"

namespace fusebench {

using namespace filter;

namespace {

FilterState moving_state() {
  FilterState x;
  x.T_world_imu = {so3_exp({0.2, -0.1, 0.3}), {0.1, -0.7, 0.4}};
  x.velocity_world_mps = {0.5, -0.2, 0.1};
  x.gravity_direction_world = Vector3d(0.2, 0.9, -0.4).normalized();
  return x;
}

StateVector some_delta(double size) {
  StateVector delta;
  for (int i = 0; i < kStateSize; ++i) delta[i] = size * std::sin(1.0 + 2.3 * i);
  return delta;
}

TEST(FilterState, MinusUndoesPlus) {
  const FilterState x = moving_state();
  const StateVector delta = some_delta(0.3);
  EXPECT_LT(testing::distance(minus(plus(x, delta), x), delta), 1e-12);
}

/// An error e before the update by delta is the error of plus(x, delta + e) against plus(x, delta) after it.
TEST(FilterState, TransportIsTheDerivativeOfTheErrorByThatBeforeTheUpdate) {
  const FilterState x = moving_state();
  for (const double size : {0.0, 0.3, 0.8}) {
    const StateVector delta = some_delta(size);
    const FilterState updated = plus(x, delta);
    const Eigen::MatrixXd numeric = testing::numeric_jacobian(
        [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
          return minus(plus(x, StateVector(delta + e)), updated);
        },
        kStateSize);
    EXPECT_LT(testing::relative_difference(chart_transport(x, delta), numeric), 1e-7) << size;
  }
}

}  // namespace
}  // namespace fusebench
