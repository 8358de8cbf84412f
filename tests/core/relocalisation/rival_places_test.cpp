#include "core/relocalisation/rival_places.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/config/groups/relocalisation_config.hpp"

namespace fusebench {

using namespace relocalisation;

namespace {

constexpr config::RelocalisationConfig kPlainConfig{};

FoundPlace at(double x_m, double support, double yaw_rad = 0) {
  FoundPlace place;
  place.T_world_camera = {so3_exp({0, yaw_rad, 0}), {x_m, 0, 0}};
  place.support = support;
  return place;
}

/// Dead reckoning that knows little.
constexpr double kUnsure_m = 4;

/// Of places that the prediction allows, best first.
bool is_only_one(const std::vector<FoundPlace>& allowed) {
  return RivalPlaces(kPlainConfig).is_only_one(0, allowed, {Vector3d::Zero(), kUnsure_m});
}

TEST(RivalPlaces, APlaceAloneIsTheOnlyOne) { EXPECT_TRUE(is_only_one({at(1, 80)})); }

TEST(RivalPlaces, AnotherElsewhereThatFitsAsWellIsARival) {
  EXPECT_FALSE(is_only_one({at(0, 80), at(3, 70)}));
  EXPECT_FALSE(is_only_one({at(0, 80), at(0.01, 75), at(3, 60)})) << "the second is the same place";
  EXPECT_FALSE(is_only_one({at(0, 0.9), at(3, 0.8)})) << "shares of depth";
  EXPECT_FALSE(is_only_one({at(0, 80), at(0, 70, std::numbers::pi)})) << "a room with two equal sides";
}

TEST(RivalPlaces, DriftIsNone) { EXPECT_TRUE(is_only_one({at(0, 80), at(0.4, 78, 0.2)})); }

/// After rivals three metres apart: of a place alone, some seconds later.
bool is_believed(double x_m, double after_s, const PredictedPosition& predicted) {
  RivalPlaces rivals(kPlainConfig);
  rivals.observe(0, std::vector{at(0, 80), at(3, 70)});
  return rivals.is_only_one(static_cast<std::int64_t>(1e9 * after_s), std::vector{at(x_m, 90)}, predicted);
}

TEST(RivalPlaces, WherePlacesRepeatDeadReckoningHasToTellThemApart) {
  EXPECT_TRUE(is_believed(3, 1, {{4, 0, 0}, 0.4}));
  EXPECT_FALSE(is_believed(3, 1, {{4.6, 0, 0}, 0.4})) << "the next one at six metres is nearer";
  EXPECT_FALSE(is_believed(3, 1, {{3, 0, 0}, 0.6})) << "three standard deviations reach between two of them";
}

TEST(RivalPlaces, TheNearestNeighboursDecideAndTheFurthestSayWhereItRepeats) {
  RivalPlaces rivals(kPlainConfig);
  rivals.observe(0, std::vector{at(9, 80), at(0, 75), at(2, 70)});
  const auto is_believed = [&](double x_m, const PredictedPosition& predicted) {
    return rivals.is_only_one(1, std::vector{at(x_m, 90)}, predicted);
  };
  EXPECT_FALSE(is_believed(14, {{17, 0, 0}, 0.3})) << "they repeat every two metres, over nine";
  EXPECT_FALSE(is_believed(14, {{14, 0, 0}, 0.4}));
  EXPECT_TRUE(is_believed(14, {{14.8, 0, 0}, 0.3}));
  EXPECT_TRUE(is_believed(18.5, {{14, 0, 0}, 2}));
}

TEST(RivalPlaces, AThirdNearThemIsNotBelievedForAWhile) {
  const PredictedPosition unsure{Vector3d::Zero(), kUnsure_m};
  EXPECT_FALSE(is_believed(5, 1, unsure)) << "two metres from the second, which was three away";
  EXPECT_TRUE(is_believed(6.5, 1, unsure)) << "where it repeats no more";
  EXPECT_TRUE(is_believed(5, 11, unsure));
  RivalPlaces rivals(kPlainConfig);
  rivals.observe(0, std::vector{at(0, 80), at(3, 70)});
  rivals.clear();
  EXPECT_TRUE(rivals.is_only_one(1, std::vector{at(5, 90)}, unsure)) << "tracked in between";
}

TEST(RivalPlaces, ThatDifferInTheirDirectionAloneHaveSurroundingsAllTheSame) {
  RivalPlaces rivals(kPlainConfig);
  rivals.observe(0, std::vector{at(0, 80), at(0, 70, std::numbers::pi)});
  EXPECT_FALSE(rivals.is_only_one(1, std::vector{at(0.1, 80)}, {Vector3d::Zero(), kUnsure_m}));
}

}  // namespace
}  // namespace fusebench
