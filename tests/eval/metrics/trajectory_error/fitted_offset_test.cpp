#include "eval/metrics/trajectory_error/fitted_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/geometry.hpp"
#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"

namespace fusebench {

using namespace trajectory_error;

namespace {

/// A hand-held motion of 10 s at 30 Hz that turns about `axes`.
Trajectory hand_held(const Vector3d& axes) {
  Trajectory trajectory;
  for (int i = 0; i < 300; ++i) {
    const double t = i / 30.0;
    const Vector3d turn =
        axes.cwiseProduct(Vector3d(std::sin(1.1 * t), std::sin(1.7 * t), std::sin(0.7 * t)));
    trajectory.push_back(
        {i * 33'333'333LL,
         {so3_exp(turn), {0.4 * std::sin(t), 0.3 * std::cos(0.8 * t), 0.2 * std::sin(1.3 * t)}}});
  }
  return trajectory;
}

/// The same motion as another point of the body makes it, in another world, with errors of some millimetres.
Trajectory seen_from(const Trajectory& motion, const Vector3d& offset_m, double noise_m) {
  std::mt19937 generator(3);
  std::normal_distribution<double> noise(0.0, noise_m);
  const SE3 T_other_world(so3_exp({0.3, -0.2, 1.0}), {3, -1, 2});
  Trajectory seen = motion;
  for (StampedPose& pose : seen) {
    pose.T_world_camera.translation = pose.T_world_camera * offset_m;
    pose.T_world_camera = T_other_world * pose.T_world_camera;
    for (int axis = 0; axis < 3; ++axis) pose.T_world_camera.translation[axis] += noise(generator);
  }
  return seen;
}

const Vector3d kOffset(-0.032, 0.011, 0.02);

TEST(FittedOffset, FindsWhereTheBodyOfTheReferenceIs) {
  const Trajectory truth = hand_held({0.5, 0.6, 0.4});
  const Trajectory estimate = seen_from(truth, kOffset, 0.0);
  EXPECT_GT(absolute_trajectory_error(truth, estimate)->stats.rmse, 0.01);
  const auto fit = fitted_offset(truth, estimate);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT((fit->offset_m - kOffset).norm(), 1e-6);
  EXPECT_LT(fit->stats.rmse, 1e-6);
  EXPECT_EQ(fit->pairs, 300U);
}

TEST(FittedOffset, WithErrorsItIsWithinItsSigmas) {
  const Trajectory truth = hand_held({0.5, 0.6, 0.4});
  const auto fit = fitted_offset(truth, seen_from(truth, kOffset, 0.004));
  ASSERT_TRUE(fit) << fit.error().message;
  const Vector3d off = fit->offset_m - kOffset;
  EXPECT_LT(off.dot(fit->covariance_m2.inverse() * off), 14.2);  // chi-square of three, 99.7 %
  EXPECT_NEAR(fit->stats.rmse, 0.004 * std::sqrt(3.0), 0.0005);
}

TEST(FittedOffset, MorePosesInTheSameSecondsAreNoMoreCertain) {
  const Trajectory truth = hand_held({0.5, 0.6, 0.4});
  Trajectory estimate = seen_from(truth, kOffset, 0.004);
  const auto all = fitted_offset(truth, estimate);
  Trajectory third;
  for (std::size_t i = 0; i < estimate.size(); i += 3) third.push_back(estimate[i]);
  const auto few = fitted_offset(truth, third);
  ASSERT_TRUE(all && few);
  ASSERT_EQ(few->pairs, 100U);
  EXPECT_NEAR(few->covariance_m2.trace() / all->covariance_m2.trace(), 1.0, 0.25);
}

TEST(FittedOffset, AMotionThatDoesNotTurnIsRefused) {
  const Trajectory truth = hand_held({0, 0, 0});
  const auto still = fitted_offset(truth, seen_from(truth, kOffset, 0.004));
  ASSERT_FALSE(still);
  EXPECT_NE(still.error().message.find("does not tell"), std::string::npos) << still.error().message;
  const Trajectory about_z = hand_held({0, 0, 0.5});  // the offset along z cannot be told
  EXPECT_FALSE(fitted_offset(about_z, seen_from(about_z, kOffset, 0.004)));
  EXPECT_FALSE(fitted_offset(about_z, about_z)) << "without any error nothing else is told";
}

TEST(FittedOffset, AnEvaluationThatAsksForItHasItBesideItsOwnNumber) {
  const Trajectory truth = hand_held({0.5, 0.6, 0.4});
  const Trajectory estimate = seen_from(truth, kOffset, 0.004);
  TrajectoryRequest request = request_for(Protocol::tum, TrajectoryMetric::ate).value();
  const auto plain = evaluate(truth, estimate, request);
  request.fit_offset = true;
  const auto both = evaluate(truth, estimate, request);
  ASSERT_TRUE(plain && both);
  EXPECT_FALSE(plain->fitted_offset);
  ASSERT_EQ(plain->series.size(), 1U);
  ASSERT_EQ(both->series.size(), 2U);
  EXPECT_EQ(both->series[0].errors, plain->series[0].errors);
  EXPECT_EQ(both->series[1].unit, "m");
  EXPECT_EQ(both->series[1].errors, fitted_offset(truth, estimate)->errors_m);
  EXPECT_EQ(both->series[1].at_ns, both->series[0].at_ns);
  EXPECT_LT((both->fitted_offset->offset_m - kOffset).norm(), 0.005);

  const Trajectory about_z = hand_held({0, 0, 0.5});
  EXPECT_FALSE(evaluate(about_z, seen_from(about_z, kOffset, 0.004), request));
}

TEST(FittedOffset, WithoutAnOffsetItIsTheAte) {
  const Trajectory truth = hand_held({0.5, 0.6, 0.4});
  const Trajectory estimate = seen_from(truth, Vector3d::Zero(), 0.004);
  const auto fit = fitted_offset(truth, estimate);
  ASSERT_TRUE(fit);
  const double plain = absolute_trajectory_error(truth, estimate)->stats.rmse;
  EXPECT_LE(fit->stats.rmse, plain);
  EXPECT_NEAR(fit->stats.rmse, plain, 0.02 * plain);
}

}  // namespace
}  // namespace fusebench
