#include "core/estimator/places/relocalisation/place_odds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/solvers.hpp"
#include "core/config/groups/relocalisation_config.hpp"

namespace fusebench {

using namespace relocalisation;

namespace {

constexpr config::RelocalisationConfig kOddsDefaults{};

/// Dead reckoning to the origin.
filter::GaussianState reckoned(double position_sigma_m, double rotation_sigma_rad = 0.1) {
  filter::GaussianState state;
  state.covariance.diagonal()
      .segment<3>(filter::kRotation)
      .setConstant(rotation_sigma_rad * rotation_sigma_rad);
  state.covariance.diagonal().segment<3>(filter::kPosition).setConstant(position_sigma_m * position_sigma_m);
  return state;
}

RelocalisedPose at(double x_m, double yaw_rad = 0) {
  RelocalisedPose pose;
  pose.T_world_imu = {so3_exp({0, yaw_rad, 0}), {x_m, 0, 0}};
  pose.covariance.diagonal().setConstant(1e-4);
  return pose;
}

std::optional<std::size_t> decide(const std::vector<RelocalisedPose>& candidates,
                                  const filter::GaussianState& prediction) {
  return PlaceOdds(kOddsDefaults).decide(candidates, prediction);
}

TEST(PlaceOdds, TheDensityOfAPoseIsThatOfStudentsT) {
  // By importance sampling: the integral over a grid of one position axis, the others at their mode, against
  // the marginal of a t distribution with 3 degrees of freedom, is the ratio of the normalisations.
  const filter::GaussianState prediction = reckoned(0.3);
  const double sigma_m = std::sqrt(0.09 + 1e-4);
  const double ratio = pose_density(prediction, at(2 * sigma_m)) / pose_density(prediction, at(0));
  EXPECT_NEAR(ratio, std::pow(1 + 4.0 / 3, -4.5), 1e-9);
  const double sigma_rad = std::sqrt(0.01 + 1e-4);
  const double mode = std::tgamma(4.5) / std::tgamma(1.5) / std::pow(3 * std::numbers::pi, 3) /
                      std::pow(sigma_m * sigma_rad, 3);
  EXPECT_NEAR(pose_density(prediction, at(0)) / mode, 1, 1e-9);
}

TEST(PlaceOdds, OneCandidateIsAcceptedUnlessDeadReckoningIsUninformative) {
  EXPECT_EQ(decide({at(0.5)}, reckoned(0.5)), 0U);
  EXPECT_EQ(decide({at(1)}, reckoned(1, 0.5)), 0U);
  EXPECT_EQ(decide({at(20)}, reckoned(20, 1.5)), std::nullopt) << "a minute of walking";
  EXPECT_EQ(decide({}, reckoned(0.1)), std::nullopt);
}

TEST(PlaceOdds, AFilterThatWasWrongBeforeItWasLostFindsTheRightPlace) {
  EXPECT_EQ(decide({at(0.1)}, reckoned(0.002, 0.002)), 0U) << "50 standard deviations";
  EXPECT_EQ(decide({at(3)}, reckoned(0.1, 0.1)), std::nullopt) << "a picture that repeats";
}

TEST(PlaceOdds, DeadReckoningSelectsAmongAmbiguousCandidates) {
  EXPECT_EQ(decide({at(3), at(0.02)}, reckoned(0.1)), 1U);
  EXPECT_EQ(decide({at(3), at(0)}, reckoned(3)), std::nullopt);
  EXPECT_EQ(decide({at(0), at(0, std::numbers::pi)}, reckoned(0.5, 2)), std::nullopt) << "two equal sides";
}

TEST(PlaceOdds, CandidatesAtOnePlaceDoNotCompete) {
  EXPECT_EQ(decide({at(0.05), at(0), at(0.4, 0.2)}, reckoned(0.5)), 0U) << "the first has the best support";
}

TEST(PlaceOdds, WhereTheSceneRepeatsAThirdPlaceIsExpectedAtTheSameDistance) {
  PlaceOdds odds(kOddsDefaults);
  const filter::GaussianState unsure = reckoned(1.5);
  EXPECT_EQ(odds.decide(std::vector{at(0), at(3)}, unsure), std::nullopt);
  EXPECT_EQ(odds.decide(std::vector{at(0)}, unsure), std::nullopt) << "the doors are 3 m apart";
  EXPECT_EQ(odds.decide(std::vector{at(0)}, reckoned(0.5)), 0U);
  odds.clear();
  EXPECT_EQ(odds.decide(std::vector{at(0)}, unsure), 0U);
}

}  // namespace

}  // namespace fusebench
