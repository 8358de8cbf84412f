// The presets that follow a route: where they go, how fast, and what they see again.
#include "datasets/simulator/routes/preset_routes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "datasets/simulator/scene/flat.hpp"
#include "tests/datasets/simulator/route_views.hpp"
#include "tests/datasets/simulator/view_overlap.hpp"

namespace fusebench {

using namespace simulator;
using namespace simulator::motion;
using namespace simulator::routes;
using testing::RoutePath;
using testing::RouteView;

namespace {

constexpr std::array kRoutes = {MotionPreset::loop_room,     MotionPreset::loop_flat,  MotionPreset::corridor,
                                MotionPreset::shake_revisit, MotionPreset::twin_rooms, MotionPreset::no_loop};

double heading_of(const SE3& T_world_camera) {
  const Vector3d forward = T_world_camera.rotation * Vector3d::UnitZ();
  return std::atan2(forward.y(), forward.x());
}

class PresetRoute : public ::testing::TestWithParam<MotionPreset> {};

TEST_P(PresetRoute, KeepsClearAndSeesWhatADepthCameraMeasures) {
  const RouteView view(GetParam(), 1);
  double measurable = 0;
  int views = 0;
  for (double time_s = 0; time_s < view.path().duration_s(); time_s += 0.5) {
    const SE3 pose = view.path().pose(time_s);
    ASSERT_GT(view.clearance_m(pose.translation), 0.3) << time_s << " s";
    measurable += view.share_within(pose, 0.4F, 4.5F);
    ++views;
  }
  EXPECT_GT(measurable / views, 0.85);
}

TEST_P(PresetRoute, StaysBelowItsPeaksAndComesToItsEnd) {
  const MotionOptions options = motion_preset(GetParam());
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const RoutePath route(GetParam(), seed);
    const PeakSpeeds peaks = route.peaks(0, route.duration_s());
    EXPECT_LT(peaks.speed_mps, options.peak_speed_mps) << seed;
    EXPECT_LT(peaks.rate_radps, options.peak_rate_radps) << seed;
    if (GetParam() == MotionPreset::shake_revisit) continue;  // continues for the requested duration
    EXPECT_GT(peaks.speed_mps, 0.5) << seed;
    EXPECT_LT(route.end_s(), route.duration_s() - 0.5) << seed;
    EXPECT_GT(route.end_s(), 0.75 * route.duration_s()) << seed;
  }
}

TEST_P(PresetRoute, IsAFunctionOfTheSeed) {
  const RoutePath first(GetParam(), 1);
  const RoutePath again(GetParam(), 1);
  const RoutePath other(GetParam(), 2);
  EXPECT_EQ(first.camera().position_world_m, again.camera().position_world_m);
  EXPECT_NE(first.camera().position_world_m, other.camera().position_world_m);
  for (std::size_t i = 0; i < first.camera().rotation_world_body.size(); ++i) {
    ASSERT_EQ(first.camera().rotation_world_body[i].coeffs(), again.camera().rotation_world_body[i].coeffs());
  }
}

INSTANTIATE_TEST_SUITE_P(All, PresetRoute, ::testing::ValuesIn(kRoutes),
                         [](const auto& preset) { return std::string(to_string(preset.param)); });

TEST(LoopRoom, ComesBackToItsStartAfterEachLap) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RoutePath route(MotionPreset::loop_room, seed);
    const SE3 start = route.pose(0);
    int laps = 0;
    double turned_rad = 0;
    double last_rad = heading_of(start);
    for (double time_s = 0; time_s < route.duration_s(); time_s += 0.05) {
      const SE3 pose = route.pose(time_s);
      turned_rad += std::remainder(heading_of(pose) - last_rad, 2 * std::numbers::pi);
      last_rad = heading_of(pose);
      if (std::abs(turned_rad) < 2 * std::numbers::pi * (laps + 1) - 0.02) continue;
      ++laps;
      EXPECT_LT((pose.translation - start.translation).norm(), 0.5) << seed << ", lap " << laps;
      EXPECT_LT(pose.rotation.angularDistance(start.rotation), radians(20)) << seed << ", lap " << laps;
    }
    EXPECT_EQ(laps, 2) << seed;
  }
}

TEST(LoopFlat, GoesRoundInEveryRoomAndComesBack) {
  using Shape = scene::FlatShape;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RoutePath route(MotionPreset::loop_flat, seed);
    std::array<double, scene::kFlatRooms> turned_rad{};
    double last_rad = heading_of(route.pose(0));
    for (double time_s = 0; time_s < route.duration_s(); time_s += 0.05) {
      const SE3 pose = route.pose(time_s);
      const double turn_rad = std::remainder(heading_of(pose) - last_rad, 2 * std::numbers::pi);
      last_rad = heading_of(pose);
      if (pose.translation.y() < Shape::kWall_m) continue;
      turned_rad.at(static_cast<std::size_t>(std::lround(pose.translation.x() / Shape::kUnit_m))) += turn_rad;
    }
    for (const double turned : turned_rad) EXPECT_GT(std::abs(turned), radians(150)) << seed;
    const SE3 start = route.pose(0);
    const SE3 end = route.pose(route.duration_s());
    EXPECT_LT((end.translation - start.translation).norm(), 0.3) << seed;
    EXPECT_LT(end.rotation.angularDistance(start.rotation), radians(20)) << seed;
  }
}

TEST(Corridor, IsWalkedOutAndBack) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RoutePath route(MotionPreset::corridor, seed);
    const SE3 start = route.pose(0);
    double furthest_m = 0;
    for (double time_s = 0; time_s < route.duration_s(); time_s += 0.1)
      furthest_m = std::max(furthest_m, route.pose(time_s).translation.x() - start.translation.x());
    EXPECT_NEAR(furthest_m, 25, 0.2) << seed;
    const SE3 end = route.pose(route.duration_s());
    EXPECT_LT((end.translation - start.translation).norm(), 0.3) << seed;
    EXPECT_LT(end.rotation.angularDistance(start.rotation), radians(20)) << seed;
  }
}

TEST(ShakeRevisit, IsQuietAtThePlaceAndShakesBetween) {
  // 1 s of rest and 1 s of a start that takes half of it; then 4 s and 2 s in turn.
  constexpr double kFirst_s = 1.5;
  constexpr double kCycle_s = 6;
  constexpr double kMargin_s = 0.3;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RoutePath route(MotionPreset::shake_revisit, seed);
    const SE3 start = route.pose(kFirst_s);
    for (int i = 0; i < 9; ++i) {
      const double quiet_s = kFirst_s + i * kCycle_s;
      const double shake_s = quiet_s + 4;
      const PeakSpeeds quiet = route.peaks(quiet_s + kMargin_s, shake_s - kMargin_s);
      EXPECT_LT(quiet.rate_radps, 0.4) << seed << ", " << i;
      EXPECT_LT(quiet.speed_mps, 0.25) << seed << ", " << i;
      const PeakSpeeds shake = route.peaks(shake_s, shake_s + 2);
      EXPECT_GT(shake.rate_radps, radians(200)) << seed << ", " << i;
      EXPECT_LT(shake.rate_radps, radians(400)) << seed << ", " << i;
      double furthest_rad = 0;
      for (double time_s = shake_s; time_s < shake_s + 2; time_s += 0.05)
        furthest_rad = std::max(furthest_rad, route.pose(time_s).rotation.angularDistance(start.rotation));
      EXPECT_GT(furthest_rad, radians(80)) << seed << ", " << i;  // nothing of the place is in view
      const SE3 back = route.pose(quiet_s + 2);
      EXPECT_LT((back.translation - start.translation).norm(), 0.25) << seed << ", " << i;
      EXPECT_LT(back.rotation.angularDistance(start.rotation), radians(15)) << seed << ", " << i;
    }
  }
}

TEST(TwinRooms, TheFirstIsNotVisitedAgain) {
  using Shape = scene::FlatShape;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RoutePath route(MotionPreset::twin_rooms, seed);
    double in_first_s = 0;
    double in_second_s = 0;
    for (double time_s = 0; time_s < route.duration_s(); time_s += 0.1) {
      const Vector3d place = route.pose(time_s).translation;
      if (place.y() < Shape::kWall_m) continue;
      const bool second = place.x() > 0.5 * Shape::kUnit_m;
      (second ? in_second_s : in_first_s) += 0.1;
      EXPECT_TRUE(second || in_second_s == 0) << seed;
    }
    EXPECT_GT(in_first_s, 20) << seed;
    EXPECT_GT(in_second_s, 20) << seed;
  }
}

testing::SeenView seen_at(const RouteView& view, double time_s) {
  return {view.renderer(), testing::kRouteCamera, view.path().pose(time_s)};
}

/// The largest share of a view that is seen again at least 10 s later, of views 2 s apart.
double most_seen_again(const RouteView& view, double end_s) {
  constexpr double kStep_s = 2;
  constexpr std::size_t kStepsApart = 5;
  std::vector<testing::SeenView> views;
  for (double time_s = 0; time_s < end_s; time_s += kStep_s) views.push_back(seen_at(view, time_s));
  double most = 0;
  for (std::size_t a = 0; a < views.size(); ++a) {
    for (std::size_t b = a + kStepsApart; b < views.size(); ++b)
      most = std::max(most, testing::share_seen_again(views[a], views[b]));
  }
  return most;
}

TEST(NoLoop, NothingIsSeenAgain) {
  const RouteView view(MotionPreset::no_loop, 1);
  EXPECT_LT(most_seen_again(view, view.path().end_s()), 0.1);
}

TEST(TwinRooms, NothingOfTheFirstIsSeenFromTheSecond) {
  const RouteView view(MotionPreset::twin_rooms, 1);
  const RoutePath& route = view.path();
  std::vector<testing::SeenView> first;
  std::vector<testing::SeenView> second;
  for (double time_s = 0; time_s < route.duration_s(); time_s += 2) {
    const SE3 pose = route.pose(time_s);
    if (pose.translation.y() < scene::FlatShape::kWall_m) continue;
    (pose.translation.x() > 0.5 * scene::FlatShape::kUnit_m ? second : first)
        .push_back(seen_at(view, time_s));
  }
  for (const testing::SeenView& a : first) {
    for (const testing::SeenView& b : second) ASSERT_LT(testing::share_seen_again(a, b), 0.02);
  }
}

TEST(LoopRoom, SeesItsStartAgain) {
  const RouteView view(MotionPreset::loop_room, 1);
  EXPECT_GT(most_seen_again(view, view.path().end_s()), 0.6);
}

}  // namespace
}  // namespace fusebench
