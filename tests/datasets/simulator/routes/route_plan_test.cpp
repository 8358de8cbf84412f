#include "datasets/simulator/routes/route_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fusebench {

using namespace simulator::routes;
using synthetic_imu::Kinematics;
using synthetic_imu::PoseSpline;

namespace {

constexpr double kSpacing_s = 0.3;

RoutePlan corner_route() {
  RoutePlan plan({0.5, 1.0}, {0, Vector3d(0, 0, 1.4), radians(170), -0.2});
  plan.move_to({2, 0, 1.4}, radians(-170), -0.2);
  plan.move_to({2, 1, 1.4}, radians(-80), -0.2);
  plan.stay(1);
  return plan;
}

std::int64_t at_s(double seconds) { return std::llround(1e9 * seconds); }

TEST(RoutePlan, TurnsTheShorterWayAndTakesTheLongerTime) {
  const RoutePlan plan = corner_route();
  EXPECT_NEAR(plan.at(4).heading_rad, radians(190), 1e-12);  // 2 m at 0.5 m/s
  EXPECT_NEAR(plan.at(2).heading_rad, radians(180), 1e-12);
  EXPECT_NEAR(plan.last().time_s, 4 + 2 + 1, 1e-12);  // 1 m at 0.5 m/s is longer than 90 degrees at 1 rad/s
  EXPECT_EQ(plan.at(-5).position_world_m, plan.at(0).position_world_m);
  EXPECT_EQ(plan.at(50).position_world_m, Vector3d(2, 1, 1.4));
}

TEST(RoutePlan, ASwingTakesTheHeadingAsItIs) {
  RoutePlan plan({0.5, 1.0}, {});
  plan.swing_to({0, 0, 0}, radians(270), 0, 0.5);
  EXPECT_NEAR(plan.at(0.25).heading_rad, radians(135), 1e-12);
}

TEST(SmoothRoute, RestsAtBothEndsAndIsNoFasterThanThePlan) {
  const RoutePlan plan = corner_route();
  const PoseSpline route = smooth_route(plan, kSpacing_s);
  for (const double time_s :
       {-3 * kSpacing_s, plan.last().time_s + 3 * kSpacing_s, plan.last().time_s + 60}) {
    const Kinematics k = route.evaluate(at_s(time_s));
    EXPECT_LT(k.velocity_world_mps.norm(), 1e-9) << time_s;
    EXPECT_LT(k.angular_velocity_body_radps.norm(), 1e-9) << time_s;
  }
  for (double time_s = -1; time_s < plan.last().time_s + 1; time_s += 0.01) {
    const Kinematics k = route.evaluate(at_s(time_s));
    ASSERT_LT(k.velocity_world_mps.norm(), 0.5 + 1e-9);
    ASSERT_LT(k.angular_velocity_body_radps.norm(), 1.02);
    const Vector3d planned = plan.at(time_s).position_world_m;
    ASSERT_LT((k.T_world_body.translation - planned).norm(), 0.5 * kSpacing_s);
  }
}

TEST(SmoothRoute, LooksAlongItsHeading) {
  const PoseSpline route = smooth_route(corner_route(), kSpacing_s);
  const Quaterniond rotation = route.evaluate(at_s(60)).T_world_body.rotation;
  const Vector3d forward = rotation * Vector3d::UnitZ();
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), radians(-80), 1e-9);
  EXPECT_NEAR(forward.z(), std::sin(-0.2), 1e-9);
  EXPECT_NEAR((rotation * Vector3d::UnitX()).z(), 0, 1e-9);  // level
}

}  // namespace
}  // namespace fusebench
