#include "core/baselines/bundlefusion/residuals.hpp"

#include <gtest/gtest.h>

#include "core/base/solvers.hpp"
#include "core/baselines/bundlefusion/dense_verification.hpp"
#include "tests/core/baselines/bundlefusion/made_views.hpp"
#include "tests/support/numeric_jacobian.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace baselines::bundlefusion;
using testing::numeric_jacobian;
using testing::relative_difference;

namespace {

const SE3 kT_world_a{so3_exp({0.3, -0.2, 0.5}), {0.4, 0.1, -0.3}};
const SE3 kT_world_b{so3_exp({0.1, 0.4, -0.2}), {-0.2, 0.3, 0.1}};
const Vector3d kPoint(0.3, -0.4, 1.7);
const Vector3d kNormal = Vector3d(0.2, 0.3, -0.9).normalized();

/// Tangents of both poses, a's first.
SE3 moved(const SE3& pose, const Eigen::VectorXd& e, Eigen::Index begin) {
  return pose_plus(pose, e.segment<6>(begin));
}

TEST(BundlefusionResiduals, PointsHaveTheNumericDerivatives) {
  const PointPair points{{0.2, 0.1, 1.5}, kPoint};
  const auto value = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    return point_residual(moved(kT_world_a, e, 0), moved(kT_world_b, e, 6), points).value_m;
  };
  const PointResidual residual = point_residual(kT_world_a, kT_world_b, points);
  Eigen::MatrixXd analytic(3, 12);
  analytic << residual.by_pose_a, residual.by_pose_b;
  EXPECT_LT(relative_difference(analytic, numeric_jacobian(value, 12)), 1e-8);
}

TEST(BundlefusionResiduals, PlanesHaveTheNumericDerivatives) {
  const Vector3d surface(0.25, -0.35, 1.6);
  const auto value = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    const SE3 T_a_b = moved(kT_world_a, e, 0).inverse() * moved(kT_world_b, e, 6);
    return Eigen::VectorXd::Constant(1, kNormal.dot(surface - T_a_b * kPoint));
  };
  const RelativeMotion motion = relative_motion(kT_world_a, kT_world_b);
  const Vector3d point_a = kT_world_a.inverse() * (kT_world_b * kPoint);
  Eigen::MatrixXd analytic(1, 12);
  analytic << -plane_direction(point_a, kNormal).transpose() * motion.by_pose_a,
      -plane_direction(point_a, kNormal).transpose() * motion.by_pose_b;
  EXPECT_LT(relative_difference(analytic, numeric_jacobian(value, 12)), 1e-8);
}

TEST(BundlefusionResiduals, PlanesDescendToTheTrueMotion) {
  const testing::TexturedRoom room;
  const PinholeCamera camera = testing::small_camera();
  const SE3 T_room_a{so3_exp({-0.35, 0.7, 0}), {0, 0, 0}};  // into a corner: planes in all directions
  const SE3 T_true{so3_exp({0.02, -0.03, 0.01}), {0.03, -0.02, 0.04}};
  const DepthCloud a = make_depth_cloud(room.render(camera, T_room_a, 0).depth_m, camera);
  const DepthCloud b = make_depth_cloud(room.render(camera, T_room_a * T_true, 0).depth_m, camera);
  SE3 T_a_b;
  for (int step = 0; step < 8; ++step) {
    const PlaneSums sums = plane_sums(a, b, T_a_b, 4.0);
    ASSERT_GT(sums.matches, 1000U);
    const Vector6d d = sums.information.ldlt().solve(sums.descent);
    T_a_b = SE3{so3_exp(d.head<3>()), d.tail<3>()} * T_a_b;
  }
  EXPECT_LT(pose_minus(T_a_b, T_true).norm(), 0.004);
  EXPECT_EQ(plane_sums(a, b, T_true, 0.1).information, Matrix6d::Zero());  // all is beyond
}

TEST(BundlefusionDenseVerification, AcceptsTheTrueMotionOnly) {
  const testing::TexturedRoom room;
  const PinholeCamera camera = testing::small_camera();
  const SE3 T_true{so3_exp({0.05, -0.2, 0.01}), {0.1, -0.02, 0.04}};
  const DepthCloud a = make_depth_cloud(room.render(camera, {}, 0).depth_m, camera);
  const DepthCloud b = make_depth_cloud(room.render(camera, T_true, 0).depth_m, camera);
  const DenseLimits limits{0.075, 0.02};
  EXPECT_TRUE(fit_together(a, b, T_true, limits));
  EXPECT_FALSE(fit_together(a, b, T_true * SE3{so3_exp({0, 0.5, 0}), {0, 0, 0}}, limits));
  EXPECT_FALSE(fit_together(a, b, SE3{T_true.rotation, {0.1, -0.02, 0.5}}, limits));
  EXPECT_FALSE(fit_together(a, b, T_true, {0.075, 0.999}));
}

TEST(BundlefusionDenseVerification, SeesWhatStandsInFrontOfASurface) {
  const DepthCloud wall = testing::wall_cloud(2.0);
  DepthImage depth_m(640, 480, 2.0F);
  for (int y = 100; y < 380; ++y) {
    for (int x = 100; x < 540; ++x) depth_m(x, y) = 1.5F;
  }
  const DepthCloud with_box = make_depth_cloud(depth_m, testing::vga_camera());
  EXPECT_TRUE(fit_together(wall, wall, {}, {0.075, 0.02}));
  EXPECT_FALSE(fit_together(wall, with_box, {}, {0.075, 0.02}));
  EXPECT_FALSE(fit_together(with_box, wall, {}, {0.075, 0.02}));
}

}  // namespace
}  // namespace fusebench
