#include "core/estimator/places/loops/loop_edges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/config/groups/loops_config.hpp"

namespace fusebench {

using namespace loops;

namespace {

constexpr std::size_t kPathPlaces = 40;

/// Along x, 0.1 m and 0.5 s apart; the filter claims a centimetre more at each.
std::vector<Place> places_along_x() {
  std::vector<Place> places(kPathPlaces);
  for (std::size_t i = 0; i < kPathPlaces; ++i) {
    const auto steps = static_cast<double>(i);
    places[i].timestamp_ns = std::llround(1e9 * 0.5 * steps);
    places[i].T_world_camera.translation = {0.1 * steps, 0, 0};
    places[i].covariance = covariance_by_axis(0.001, 0.01) * steps;
  }
  return places;
}

/// The path is off by that much between the two.
LoopCandidate verified(const std::vector<Place>& places, std::size_t known, std::size_t query,
                       const Vector3d& path_is_off_m) {
  LoopCandidate candidate;
  candidate.known = known;
  candidate.query = query;
  candidate.pair.same = true;
  candidate.pair.T_known_query = places[known].T_world_camera.inverse() * places[query].T_world_camera;
  candidate.pair.T_known_query.translation += path_is_off_m;
  candidate.pair.covariance = covariance_by_axis(0.001, 0.002);
  return candidate;
}

std::vector<bool> accepted(const std::vector<Place>& places, std::vector<LoopCandidate> candidates) {
  decide(places, config::LoopsConfig{}, candidates);
  std::vector<bool> are;
  for (const LoopCandidate& candidate : candidates) are.push_back(candidate.accepted);
  return are;
}

using Accepted = std::vector<bool>;

/// The path claims 0.06 m from the first place to the last one, and three times as much is allowed for.
TEST(LoopEdges, AreAcceptedWithinDriftAloneAndBeyondItWithSupport) {
  const std::vector<Place> places = places_along_x();
  const auto edge = [&](std::size_t known, std::size_t query, double off_m) {
    return verified(places, known, query, {0, off_m, 0});
  };
  EXPECT_EQ(accepted(places, {edge(0, 36, 0.5)}), (Accepted{true})) << "2.7 sigmas";
  EXPECT_EQ(accepted(places, {edge(0, 36, 1.5)}), (Accepted{false})) << "8 sigmas";
  EXPECT_EQ(accepted(places, {edge(0, 36, 1.5), edge(1, 38, 1.5)}), (Accepted{true, true}));
  EXPECT_EQ(accepted(places, {edge(0, 36, 1.5), edge(1, 38, -1.5)}), (Accepted{false, false}))
      << "they do not agree";
  EXPECT_EQ(accepted(places, {edge(0, 30, 1.4), edge(1, 38, 1.4)}), (Accepted{false, false})) << "4 s apart";
  EXPECT_EQ(accepted(places, {edge(0, 36, 1.5), edge(1, 36, 1.5)}), (Accepted{false, false}))
      << "one image is no second witness";
  EXPECT_EQ(accepted(places, {edge(0, 36, 6), edge(1, 38, 6)}), (Accepted{false, false}))
      << "32 sigmas: nothing supports that";
}

TEST(LoopEdges, AcceptsASelfRelocalisation) {
  const std::vector<Place> places = places_along_x();
  for (const LoopEvidence evidence : {LoopEvidence::pair_and_tracker, LoopEvidence::tracker_alone}) {
    LoopCandidate near = verified(places, 0, 36, {0, 1.5, 0});
    LoopCandidate far = verified(places, 0, 36, {0, 6, 0});
    near.evidence = far.evidence = evidence;
    EXPECT_EQ(accepted(places, {near, far}), (Accepted{true, false}));
    EXPECT_FALSE(loop_edge(places, near, {}).robust) << "the current world is by it";
  }
}

/// Both at the same wrong door would agree with each other.
TEST(LoopEdges, ATrackerAloneSupportsNoOther) {
  const std::vector<Place> places = places_along_x();
  LoopCandidate found = verified(places, 0, 36, {0, 1.5, 0});
  const LoopCandidate other = verified(places, 1, 38, {0, 1.5, 0});
  found.evidence = LoopEvidence::tracker_alone;
  EXPECT_EQ(accepted(places, {found, other}), (Accepted{true, false}));
  found.evidence = LoopEvidence::pair_and_tracker;
  EXPECT_EQ(accepted(places, {found, other}), (Accepted{true, true}));
}

/// Against the edge between the places where they are a little later.
TEST(LoopEdges, UncertainInstantsMoveAnEdgeAlongTheMotionOfItsPlaces) {
  std::vector<Place> places = places_along_x();
  Place& known = places[0];
  Place& query = places[36];
  known.T_world_camera.rotation = so3_exp({0.3, -0.2, 0.5});
  query.T_world_camera.rotation = so3_exp({-0.4, 0.1, 0.2});
  known.angular_velocity_camera_radps = {0.5, -0.8, 0.3};
  known.velocity_camera_mps = {0.2, 0.4, -0.1};
  query.angular_velocity_camera_radps = {-0.2, 0.6, 0.9};
  query.velocity_camera_mps = {-0.3, 0.1, 0.5};
  const auto later = [](const Place& place, double time_s) {
    const SE3& pose = place.T_world_camera;
    return SE3{pose.rotation * so3_exp(time_s * place.angular_velocity_camera_radps),
               pose.translation + time_s * (pose.rotation * place.velocity_camera_mps)};
  };
  const SE3 T_known_query = known.T_world_camera.inverse() * query.T_world_camera;
  constexpr double kStep_s = 1e-6;
  const Vector6d by_known =
      pose_minus(later(known, kStep_s).inverse() * query.T_world_camera, T_known_query) / kStep_s;
  const Vector6d by_query =
      pose_minus(known.T_world_camera.inverse() * later(query, kStep_s), T_known_query) / kStep_s;
  const LoopCandidate candidate = verified(places, 0, 36, Vector3d::Zero());
  config::LoopsConfig exact;
  exact.timing_sigma_s = 0;
  config::LoopsConfig uncertain;
  uncertain.timing_sigma_s = 0.02;
  const Matrix6d added =
      loop_edge(places, candidate, uncertain).covariance - loop_edge(places, candidate, exact).covariance;
  const Matrix6d expected = 0.02 * 0.02 * (by_known * by_known.transpose() + by_query * by_query.transpose());
  EXPECT_LT((added - expected).norm(), 1e-5 * expected.norm());
}

TEST(LoopEdges, TheDriftOfThePathIsEnlargedByTheSquareOfItsFactor) {
  const std::vector<Place> places = places_along_x();
  config::LoopsConfig once;
  once.drift_factor = 1;
  config::LoopsConfig thrice;
  thrice.drift_factor = 3;
  const Matrix6d floor = covariance_by_axis(once.path_rotation_sigma_rad, once.path_position_sigma_m);
  const Matrix6d drift = path_edge(places, 0, 36, once).covariance - floor;
  EXPECT_GT(drift.norm(), 1e-4);
  EXPECT_LT((path_edge(places, 0, 36, thrice).covariance - floor - 9.0 * drift).norm(), 1e-9 * drift.norm());
}

TEST(LoopEdges, WhatIsNotVerifiedIsNotAccepted) {
  const std::vector<Place> places = places_along_x();
  LoopCandidate candidate = verified(places, 0, 36, Vector3d::Zero());
  candidate.pair.same = false;
  EXPECT_EQ(accepted(places, {candidate}), (Accepted{false}));
}

}  // namespace
}  // namespace fusebench
