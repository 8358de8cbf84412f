#include "core/baselines/bundlefusion/pair_filters.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/baselines/bundlefusion/matching.hpp"
#include "tests/core/baselines/bundlefusion/made_views.hpp"

namespace fusebench {

using namespace baselines::bundlefusion;
using testing::made_descriptor;
using testing::made_keypoint;
using testing::vga_camera;

namespace {

const SE3 kT_a_b{so3_exp({0.05, -0.1, 0.03}), {0.1, -0.05, 0.02}};

/// Two frames of the same points, the first `outliers` of which are elsewhere in the second one, and matches
/// in their order.
struct TwoFrames {
  Keypoints a;
  Keypoints b;
  std::vector<KeypointMatch> matches;

  explicit TwoFrames(std::size_t outliers, std::size_t count = 30) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto draw = [&] {
      const double z_m = 2 + 0.5 * uniform(random);
      return Vector3d(0.5 * uniform(random) * z_m, 0.4 * uniform(random) * z_m, z_m);
    };
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3d point_a = draw();
      const Vector3d point_b = i < outliers ? draw() : kT_a_b.inverse() * point_a;
      a.push_back(made_keypoint(vga_camera(), point_a, i));
      b.push_back(made_keypoint(vga_camera(), point_b, i));
      matches.push_back({i, i, 0.1 + 0.001 * static_cast<double>((i * 7) % count)});
    }
  }
};

TEST(BundlefusionMatching, TakesMutualNearestNeighboursThatAreClearAndNoOthers) {
  TwoFrames frames(0, 10);
  // Two that look alike are no match for either.
  frames.b[4].descriptor = frames.b[5].descriptor = frames.a[4].descriptor;
  const auto matches = match_keypoints(frames.a, frames.b);
  ASSERT_EQ(matches.size(), 8U);
  for (const KeypointMatch& match : matches) {
    EXPECT_EQ(match.a, match.b);
    EXPECT_NE(match.a, 4U);
    EXPECT_NEAR(match.distance, 0, 1e-6);
  }
  EXPECT_TRUE(match_keypoints(frames.a, {}).empty());
  EXPECT_TRUE(match_keypoints({}, frames.b).empty());
}

TEST(BundlefusionPairFilters, FindTheMotionAmongOutliers) {
  const TwoFrames frames(8);
  std::vector<KeypointMatch> matches = frames.matches;
  std::ranges::sort(matches, {}, &KeypointMatch::distance);
  const auto rigid = filter_by_motion(matches, frames.a, frames.b);
  ASSERT_TRUE(rigid.has_value());
  EXPECT_GE(rigid->matches.size(), 15U);
  EXPECT_LE(rigid->matches.size(), 25U);
  EXPECT_EQ(rigid->matches.size(), rigid->points.size());
  for (const KeypointMatch& match : rigid->matches) EXPECT_GE(match.a, 8U);
  EXPECT_LT(pose_minus(rigid->T_a_b, kT_a_b).norm(), 1e-9);
}

TEST(BundlefusionPairFilters, RejectFewMatchesAndThoseOnALine) {
  const TwoFrames frames(0);
  const std::span<const KeypointMatch> all = frames.matches;
  EXPECT_FALSE(filter_by_motion(all.first(4), frames.a, frames.b).has_value());
  EXPECT_TRUE(filter_by_motion(all.first(12), frames.a, frames.b).has_value());
  Keypoints line;
  for (std::size_t i = 0; i < 12; ++i)
    line.push_back(made_keypoint(vga_camera(), {0.1 * static_cast<double>(i) - 0.6, 0.05, 2.0}, i));
  EXPECT_FALSE(filter_by_motion(all.first(12), line, line).has_value());
}

TEST(BundlefusionPairFilters, TakeNoTwoMatchesNextToEachOther) {
  TwoFrames frames(0, 12);
  for (std::size_t i = 6; i < 12; ++i) {
    frames.a[i] = frames.a[i - 6];
    frames.b[i] = frames.b[i - 6];
  }
  const auto rigid = filter_by_motion(frames.matches, frames.a, frames.b);
  ASSERT_TRUE(rigid.has_value());
  EXPECT_EQ(rigid->matches.size(), 6U);
}

TEST(BundlefusionPairFilters, MeasureTheAreaInThePlaneOfThePoints) {
  // A square of 0.3 m, tilted, with a diagonal cross so that its axes are those of the square.
  const Quaterniond tilt = so3_exp({0.4, -0.3, 0.2});
  std::vector<Vector3d> square;
  for (const double x : {-0.2, 0.2}) {
    for (const double y : {-0.15, 0.15}) square.push_back(tilt * Vector3d(x, y, 0) + Vector3d(0, 0, 2));
  }
  EXPECT_NEAR(box_area_m2(square), 0.4 * 0.3, 1e-12);
  std::vector<PointPair> pairs;
  for (const Vector3d& point : square) pairs.push_back({point, kT_a_b.inverse() * point});
  EXPECT_TRUE(covers_enough_area(pairs));
  for (PointPair& pair : pairs) pair.point_b *= 0.5;  // a quarter of the area: 0.03 square metres
  EXPECT_FALSE(covers_enough_area(pairs));
}

}  // namespace
}  // namespace fusebench
