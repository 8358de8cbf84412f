#include "core/estimator/places/place_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>

#include "core/config/groups/relocalisation_config.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace places;

namespace {

using config::PlaceFeaturesConfig;

constexpr PlaceFeaturesConfig kFeatureDefaults{};

GreyImage room_image() { return testing::TexturedRoom{}.render(testing::small_camera(), SE3{}, 0).grey; }

PlaceFeature with_bits(int set_bits) {
  PlaceFeature feature;
  for (int bit = 0; bit < set_bits; ++bit)
    feature.descriptor[static_cast<std::size_t>(bit / 64)] |= std::uint64_t{1} << (bit % 64);
  return feature;
}

TEST(PlaceFeatures, DistanceCountsTheBitsThatDiffer) {
  EXPECT_EQ(hamming_distance(with_bits(0).descriptor, with_bits(256).descriptor), 256);
  EXPECT_EQ(hamming_distance(with_bits(70).descriptor, with_bits(75).descriptor), 5);
  EXPECT_EQ(hamming_distance(with_bits(70).descriptor, with_bits(70).descriptor), 0);
}

TEST(PlaceFeatures, MatchesAreMutualNearAndDistinct) {
  const auto match_one = [](const PlaceFeature& query, const std::vector<PlaceFeature>& known) {
    return match_features(std::vector<PlaceFeature>{query}, known, kFeatureDefaults);
  };
  ASSERT_EQ(match_one(with_bits(100), {with_bits(160), with_bits(110)}).size(), 1U);
  EXPECT_EQ(match_one(with_bits(100), {with_bits(160), with_bits(110)}).front().known, 1U);
  EXPECT_TRUE(match_one(with_bits(100), {with_bits(110), with_bits(112)}).empty())
      << "10 is not below 0.8 x 12";
  EXPECT_TRUE(match_one(with_bits(100), {with_bits(170)}).empty()) << "70 bits are too many";
  EXPECT_TRUE(match_one(with_bits(100), {}).empty());
  // Both match the same reference feature; the nearer one is accepted.
  const std::vector<PlaceFeature> queries{with_bits(120), with_bits(104)};
  const auto matches = match_features(queries, std::vector<PlaceFeature>{with_bits(100)}, kFeatureDefaults);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches.front().query, 1U);
}

TEST(PlaceFeatures, CornersAreWhereTheImageHasThem) {
  GreyImage grey(200, 150, 60);
  grey(50, 61) = 200;
  grey(119, 88) = 200;
  grey(5, 5) = 200;  // too close to the border to be described
  const std::vector<Vector2d> corners_px = find_corners(grey, kFeatureDefaults);
  ASSERT_EQ(corners_px.size(), 2U);
  EXPECT_EQ(corners_px[0], Vector2d(50, 61));
  EXPECT_EQ(corners_px[1], Vector2d(119, 88));
  EXPECT_TRUE(find_corners(GreyImage(62, 62, 9), kFeatureDefaults).empty());
}

TEST(PlaceFeatures, AreSpreadInsideAndAtMostMaxCount) {
  const GreyImage grey = room_image();
  const auto features = find_place_features(grey, PlaceFeaturesConfig{.max_count = 300});
  EXPECT_LE(features.size(), 300U);
  ASSERT_GT(features.size(), 150U);
  std::set<std::pair<int, int>> cells;
  for (const PlaceFeature& f : features) {
    EXPECT_TRUE(grey.contains(static_cast<int>(f.pixel_px.x()), static_cast<int>(f.pixel_px.y())));
    EXPECT_GE(f.scale, 1.0);
    cells.insert({static_cast<int>(f.pixel_px.x()) / 80, static_cast<int>(f.pixel_px.y()) / 60});
  }
  EXPECT_GE(cells.size(), 14U);
}

TEST(PlaceFeatures, AFewRichSpotsDoNotTakeAll) {
  // Strong noise in a stripe, the fainter room elsewhere.
  GreyImage grey = room_image();
  std::mt19937 random(5);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 60; ++x) grey(x, y) = static_cast<std::uint8_t>(random() & 255U);
  }
  const auto features = find_place_features(grey, PlaceFeaturesConfig{.max_count = 240});
  const auto right = std::count_if(features.begin(), features.end(),
                                   [](const PlaceFeature& f) { return f.pixel_px.x() > 160; });
  EXPECT_GT(right, 60);
}

TEST(PlaceFeatures, AnImageOnItsSideIsRecognised) {
  const GreyImage upright = room_image();
  GreyImage turned(upright.height, upright.width);
  for (int y = 0; y < upright.height; ++y) {
    for (int x = 0; x < upright.width; ++x) turned(upright.height - 1 - y, x) = upright(x, y);
  }
  const auto a = find_place_features(upright, PlaceFeaturesConfig{.max_count = 400});
  const auto b = find_place_features(turned, PlaceFeaturesConfig{.max_count = 400});
  const auto matches = match_features(a, b, kFeatureDefaults);
  int right = 0;
  for (const FeatureMatch& m : matches) {
    const Vector2d& p = a[m.query].pixel_px;
    const Vector2d expected(upright.height - 1 - p.y(), p.x());
    right += (b[m.known].pixel_px - expected).norm() < 2 * a[m.query].scale ? 1 : 0;
  }
  EXPECT_GT(matches.size(), 100U);
  EXPECT_GT(right, 0.9 * static_cast<double>(matches.size()));
}

TEST(PlaceFeatures, PlainAndTinyImagesHaveNone) {
  EXPECT_TRUE(find_place_features(GreyImage(320, 240, 77), kFeatureDefaults).empty());
  EXPECT_TRUE(find_place_features(GreyImage(40, 30, 77), kFeatureDefaults).empty());
  EXPECT_TRUE(find_place_features(GreyImage(), kFeatureDefaults).empty());
}

}  // namespace
}  // namespace fusebench
