#include "core/base/geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/estimator/filter/filter_state.hpp"
#include "tests/support/numeric_jacobian.hpp"

namespace fusebench {

using namespace filter;

namespace {

using testing::numeric_jacobian;
using testing::relative_difference;

/// Rotation vectors from tiny to nearly pi, in several directions.
std::vector<Vector3d> rotation_vectors() {
  std::vector<Vector3d> result;
  for (const double angle : {0.0, 1e-12, 1e-7, 9e-6, 1.1e-5, 1e-3, 0.3, 1.7, 3.1}) {
    for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, -1, 0), Vector3d(1, 2, -3)}) {
      result.push_back(angle * axis.normalized());
    }
  }
  return result;
}

TEST(Geometry, HatIsTheCrossProduct) {
  const Vector3d a(1, -2, 3);
  const Vector3d b(-4, 5, 0.5);
  EXPECT_LT((hat(a) * b - a.cross(b)).norm(), 1e-15);
}

TEST(Geometry, ExpEqualsTheMatrixExponential) {
  for (const Vector3d& phi : rotation_vectors()) {
    Matrix3d expected = Matrix3d::Identity();  // the power series, written out
    Matrix3d term = Matrix3d::Identity();
    for (int n = 1; n < 40; ++n) {
      term = term * hat(phi) / n;
      expected += term;
    }
    EXPECT_LT((so3_exp(phi).toRotationMatrix() - expected).norm(), 1e-13) << phi.transpose();
  }
}

TEST(Geometry, LogInvertsExpAndIgnoresTheSignOfTheQuaternion) {
  for (const Vector3d& phi : rotation_vectors()) {
    Quaterniond q = so3_exp(phi);
    EXPECT_LT((so3_log(q) - phi).norm(), 1e-13) << phi.transpose();
    q.coeffs() *= -1.0;
    EXPECT_LT((so3_log(q) - phi).norm(), 1e-13) << phi.transpose();
  }
}

TEST(Geometry, RightJacobianEqualsNumericDerivative) {
  for (const Vector3d& phi : rotation_vectors()) {
    const auto f = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
      return so3_log(so3_exp(phi).conjugate() * so3_exp(phi + Vector3d(e)));
    };
    EXPECT_LT(relative_difference(so3_right_jacobian(phi), numeric_jacobian(f, 3)), 1e-8) << phi.transpose();
  }
}

TEST(Geometry, TransformsComposeAndInvert) {
  const SE3 T_a_b{so3_exp({0.3, -0.2, 1.0}), {1, 2, 3}};
  const SE3 T_b_c{so3_exp({-1.0, 0.1, 0.2}), {-0.5, 0.4, 2}};
  const Vector3d point_c(0.2, 0.7, -3);
  EXPECT_LT(((T_a_b * T_b_c) * point_c - T_a_b * (T_b_c * point_c)).norm(), 1e-14);
  EXPECT_LT((T_a_b.inverse() * (T_a_b * point_c) - point_c).norm(), 1e-14);
}

TEST(Geometry, InterpolationMeetsBothEndsAndHalvesTheAngle) {
  const SE3 a{so3_exp({0.1, 0.2, 0.3}), {0, 0, 0}};
  const SE3 b{so3_exp({-0.4, 0.9, 0.2}), {1, -2, 4}};
  EXPECT_LT(rotation_angle_rad(interpolate(a, b, 0).rotation, a.rotation), 1e-12);
  EXPECT_LT(rotation_angle_rad(interpolate(a, b, 1).rotation, b.rotation), 1e-12);
  const SE3 middle = interpolate(a, b, 0.5);
  EXPECT_NEAR(rotation_angle_rad(a.rotation, middle.rotation),
              0.5 * rotation_angle_rad(a.rotation, b.rotation), 1e-12);
  EXPECT_LT((middle.translation - Vector3d(0.5, -1, 2)).norm(), 1e-15);
}

TEST(Geometry, DirectionsMoveAlongTheSphereAndBack) {
  for (const Vector3d& direction :
       {Vector3d(0, 1, 0), Vector3d(0, 0, -1), Vector3d(0.6, -0.8, 0.0), Vector3d(1, 1, 1).normalized()}) {
    const Matrix3x2d basis = s2_basis(direction);
    EXPECT_LT((basis.transpose() * basis - Eigen::Matrix2d::Identity()).norm(), 1e-14);
    EXPECT_LT((basis.transpose() * direction).norm(), 1e-14);
    for (const Vector2d& delta :
         {Vector2d(0, 0), Vector2d(1e-9, 0), Vector2d(0.3, -0.4), Vector2d(-1.5, 2.0)}) {
      const Vector3d moved = s2_plus(direction, delta);
      EXPECT_NEAR(moved.norm(), 1.0, 1e-14);
      EXPECT_NEAR(std::acos(std::clamp(moved.dot(direction), -1.0, 1.0)), delta.norm(), 1e-7);
      EXPECT_LT((s2_minus(moved, direction) - delta).norm(), 1e-12);
    }
  }
}

FilterState some_state() {
  FilterState x;
  x.T_world_imu = {so3_exp({0.4, -0.8, 0.3}), {0.1, -0.7, 2.0}};
  x.velocity_world_mps = {0.5, -0.2, 0.1};
  x.gyroscope_bias_radps = {0.01, -0.02, 0.005};
  x.accelerometer_bias_mps2 = {0.1, 0.05, -0.2};
  x.gravity_direction_world = Vector3d(0.2, 0.9, -0.4).normalized();
  x.angular_velocity_imu_radps = {1.0, -0.5, 0.3};
  return x;
}

StateVector some_delta() {
  StateVector d;
  for (int i = 0; i < kStateSize; ++i) d[i] = 0.05 * (i % 7 - 3) + 0.01 * i;
  return d;
}

TEST(FilterState, MinusInvertsPlus) {
  EXPECT_LT((minus(plus(some_state(), some_delta()), some_state()) - some_delta()).norm(), 1e-12);
}

TEST(FilterState, ChartTransportEqualsNumericDerivative) {
  const FilterState there = plus(some_state(), some_delta());
  const auto f = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    return minus(plus(some_state(), some_delta() + StateVector(e)), there);
  };
  EXPECT_LT(relative_difference(chart_transport(some_state(), some_delta()), numeric_jacobian(f, kStateSize)),
            1e-8);
}

}  // namespace
}  // namespace fusebench
