#include "core/estimator/places/loops/odometry_world.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/geometry.hpp"
#include "core/estimator/places/loops/loop_edges.hpp"

namespace fusebench {

using namespace loops;

namespace {

const SE3 kOdometry{so3_exp({0.1, 0.2, -0.3}), {1, 2, 3}};
const SE3 kFoundAt{so3_exp({-0.2, 0.1, 0.4}), {1.3, 1.8, 2.5}};
const SE3 kCorrection{so3_exp({0, 0.3, 0}), {0, 0.2, 0}};

Relocalisation found_again(const SE3& T_odometry_camera, double predicted_m, double found_m) {
  Relocalisation found;
  found.T_odometry_camera = T_odometry_camera;
  found.predicted_covariance = covariance_by_axis(0.01, predicted_m);
  found.found_covariance = covariance_by_axis(0.01, found_m);
  return found;
}

double apart(const SE3& a, const SE3& b) { return pose_minus(a, b).norm(); }

TEST(OdometryWorld, ContinuesAsPredictedWhileTheCurrentFrameMoves) {
  OdometryWorld world;
  EXPECT_LT(apart(world.T_current_camera(kOdometry, 0), kOdometry), 1e-12);
  world.relocalise(found_again(kOdometry, 0.1, 0.01), kFoundAt, {kOdometry, covariance_by_axis(0.01, 0.01)});
  EXPECT_LT(apart(world.T_current_camera(kOdometry, 1), kFoundAt), 1e-12);
  EXPECT_LT(apart(world.T_current_camera(kOdometry, 0), kOdometry), 1e-12) << "poses before stay";
  world.correct(kCorrection * world.T_current_odometry());
  EXPECT_LT(apart(world.T_current_camera(kOdometry, 1), kCorrection * kFoundAt), 1e-12);
  EXPECT_LT(apart(world.T_current_camera(kOdometry, 0), kCorrection * kOdometry), 1e-12);
  EXPECT_LT(apart(world.T_relocalised_camera(kOdometry, 1), kFoundAt), 1e-12) << "a correction is none";
}

TEST(OdometryWorld, CountsDeadReckoningOnce) {
  OdometryWorld world;
  EXPECT_EQ(world.lost_covariance_at(kOdometry).norm(), 0);
  const OdometryPose last{kOdometry, covariance_by_axis(0.01, 0.02)};
  world.relocalise(found_again(kOdometry, 0.1, 0.05), kFoundAt, last);
  const Matrix6d lost = world.lost_covariance_at(kOdometry);
  EXPECT_LT((lost - covariance_by_axis(0, std::sqrt(0.1 * 0.1 - 0.02 * 0.02))).norm(), 1e-9);
  // Found again in the next frame, which dead reckoning added nothing to.
  const Relocalisation& before = world.relocalisation(1);
  world.relocalise(found_again(kOdometry, 0.05, 0.05), kFoundAt,
                   {before.T_odometry_camera, before.found_covariance});
  EXPECT_LT((world.lost_covariance_at(kOdometry) - lost).norm(), 1e-9);
}

/// Derivative of a rigidly connected pose by the error of another one, by small displacements.
Matrix6d carried_by(const SE3& from, const SE3& to) {
  constexpr double kStep = 1e-6;
  Matrix6d jacobian;
  for (int k = 0; k < 6; ++k) {
    const SE3 displaced = pose_plus(from, kStep * Vector6d::Unit(k));
    jacobian.col(k) = pose_minus(displaced * from.inverse() * to, to) / kStep;
  }
  return jacobian;
}

TEST(OdometryWorld, DeadReckoningAddsNothingOfItsInitialError) {
  OdometryWorld world;
  const SE3 last = kOdometry;
  const SE3 found_at = kOdometry * SE3{so3_exp({0.3, -0.1, 0.2}), {0.5, 1.0, -2.0}};
  const Matrix6d before = covariance_by_axis(0.02, 0.01);
  const Matrix6d added = covariance_by_axis(0.03, 0.2);
  const Matrix6d carried = carried_by(last, found_at);
  Relocalisation found = found_again(found_at, 0, 0.01);
  found.predicted_covariance = carried * before * carried.transpose() + added;
  world.relocalise(found, kFoundAt, {last, before});
  EXPECT_LT((world.lost_covariance_at(found_at) - added).norm(), 1e-6);
  // The error is in the odometry frame: at another position its rotation has a lever arm.
  const Matrix6d back = carried_by(found_at, last);
  EXPECT_LT((world.lost_covariance_at(last) - back * added * back.transpose()).norm(), 1e-5);
}

}  // namespace
}  // namespace fusebench
