#include "core/estimator/places/dense_alignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/config/config.hpp"
#include "core/estimator/places/depth_agreement.hpp"
#include "core/estimator/places/place_verification.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace places;
using testing::small_camera;
using testing::TexturedRoom;

namespace {

/// Towards a corner of the room, so that surfaces face all directions.
const SE3 kCorner{so3_exp({-0.45, 0.6, 0}), {0, 0, 0}};
const SE3 kTrue{so3_exp({0.02, 0.1, -0.03}), {0.08, -0.03, 0.05}};  // T_known_query
const SE3 kStart = pose_plus(kTrue, (Vector6d() << 0.02, -0.03, 0.02, 0.03, 0.02, -0.03).finished());

Appearance appearance_at(const SE3& T_world_camera, const config::Config& config,
                         const TexturedRoom& room = {}) {
  return appearance_of(room.render(small_camera(), T_world_camera, 1), small_camera(), config.loops,
                       config.place_features, config.relocalisation);
}

/// A wall across the view, and nothing else.
TexturedRoom wall() {
  TexturedRoom room;
  room.room = Eigen::AlignedBox3d(Vector3d(-50, -50, -1), Vector3d(50, 50, 2));
  room.furniture.clear();
  return room;
}

RelativePose start_with(double rotation_sigma_rad, double position_sigma_m) {
  RelativePose start{kStart, Matrix6d::Zero()};
  start.covariance.diagonal() << Vector3d::Constant(rotation_sigma_rad * rotation_sigma_rad),
      Vector3d::Constant(position_sigma_m * position_sigma_m);
  return start;
}

TEST(DenseAlignment, DepthAloneFindsThePose) {
  const config::Config config;
  const auto found =
      aligned_by_depth(appearance_at(kCorner, config).small, appearance_at(kCorner * kTrue, config).small,
                       {start_with(1, 1), false, 0}, small_camera(), config.depth, config.loops);
  ASSERT_TRUE(found);
  EXPECT_LT(rotation_angle_rad(found->T_known_query.rotation, kTrue.rotation), radians(0.3));
  EXPECT_LT((found->T_known_query.translation - kTrue.translation).norm(), 0.006);
  EXPECT_LT(largest_sigma(found->covariance.bottomRightCorner<3, 3>()), 0.02);
}

/// The axes of the two cameras differ, so that a normal in the axes of the wrong one leads away.
TEST(DenseAlignment, DepthAloneFindsThePoseOfARolledCamera) {
  const config::Config config;
  const SE3 rolled{so3_exp({0, 0, 1.4}), {0.05, -0.03, 0.04}};
  const Vector6d off = (Vector6d() << 0.03, -0.04, 0.03, 0.04, 0.03, -0.04).finished();
  const RelativePose start{pose_plus(rolled, off), Matrix6d::Identity()};
  const auto found =
      aligned_by_depth(appearance_at(kCorner, config).small, appearance_at(kCorner * rolled, config).small,
                       {start, false, 0}, small_camera(), config.depth, config.loops);
  ASSERT_TRUE(found);
  EXPECT_LT(rotation_angle_rad(found->T_known_query.rotation, rolled.rotation), radians(0.3));
  EXPECT_LT((found->T_known_query.translation - rolled.translation).norm(), 0.006);
}

/// Error after a second without images: 30 cm and 7 degrees.
TEST(DenseAlignment, AWideReachFindsThePoseFromFarAway) {
  const config::Config config;
  const SmallImages known = appearance_at(kCorner, config).small;
  const SmallImages query = appearance_at(kCorner * kTrue, config).small;
  const RelativePose start{pose_plus(kTrue, (Vector6d() << 0.07, -0.08, 0.06, 0.2, -0.15, 0.17).finished()),
                           Matrix6d::Identity()};
  const auto error_m = [&](double reach_m) {
    const auto found =
        aligned_by_depth(known, query, {start, false, reach_m}, small_camera(), config.depth, config.loops);
    return found ? (found->T_known_query.translation - kTrue.translation).norm() : 1.0;
  };
  EXPECT_GT(error_m(0), 0.05) << "the start is too near: the test is empty";
  EXPECT_LT(error_m(0.5), 0.006);
}

TEST(DenseAlignment, AWallLeavesThePoseToTheFeatures) {
  const config::Config config;
  const Appearance known = appearance_at({}, config, wall());
  const Appearance query = appearance_at(kTrue, config, wall());
  EXPECT_FALSE(aligned_by_depth(known.small, query.small, {start_with(1, 1), false, 0}, small_camera(),
                                config.depth, config.loops));
  const auto found = aligned_by_depth(known.small, query.small, {start_with(0.01, 0.01), true, 0},
                                      small_camera(), config.depth, config.loops);
  ASSERT_TRUE(found);
  const Vector3d moved = found->T_known_query.translation - kTrue.translation;
  const Vector3d before = kStart.translation - kTrue.translation;
  EXPECT_LT(std::abs(moved.z()), 0.3 * std::abs(before.z())) << "the distance is told by depth";
  EXPECT_NEAR(moved.x(), before.x(), 0.01) << "where along the wall is not";
  EXPECT_GT(found->covariance(3, 3), 10 * found->covariance(5, 5));
}

TEST(DenseAlignment, TooLittleDepthIsNoPose) {
  const config::Config config;
  const Appearance known = appearance_at(kCorner, config);
  Appearance query = appearance_at(kCorner * kTrue, config);
  std::fill(query.small.depth_m.data.begin(), query.small.depth_m.data.end(), 0.0F);
  EXPECT_FALSE(aligned_by_depth(known.small, query.small, {start_with(1, 1), false, 0}, small_camera(),
                                config.depth, config.loops));
}

TEST(DepthAgreement, APlaceAgreesWithItselfAndNotWithOneElsewhere) {
  const config::Config config;
  const Appearance here = appearance_at({}, config);
  const DepthAgreement same =
      depth_agreement(here.small, here.small, SE3{}, small_camera(), config.depth, config.loops);
  EXPECT_GT(same.overlap, 0.99);
  EXPECT_GT(same.consistent, 0.99);
  EXPECT_EQ(same.violating, 0);
  EXPECT_NEAR(grey_correlation(here.small, here.small, SE3{}, small_camera(), config.depth, config.loops,
                               config.health.min_contrast_grey)
                  .value(),
              1, 1e-9);
  const Appearance nearer = appearance_at({Quaterniond::Identity(), {0, 0, 0.4}}, config);
  EXPECT_GT(
      depth_agreement(nearer.small, here.small, SE3{}, small_camera(), config.depth, config.loops).violating,
      0.5)
      << "surfaces stand where the other place saw free space";
  EXPECT_LT(
      depth_agreement(here.small, nearer.small, SE3{}, small_camera(), config.depth, config.loops).violating,
      0.1)
      << "and behind what the other one saw: hidden";
}

/// Features are gone by blur: the pair is verified by depth, starting where the path leads.
TEST(PlaceVerification, WithoutFeaturesDepthVerifiesAndIntensitiesHaveToFit) {
  const config::Config config;
  const Appearance known = appearance_at(kCorner, config);
  Appearance query = appearance_at(kCorner * kTrue, config);
  query.landmarks = {};
  const VerifiedPair pair = verify_pair(known, query, kStart, small_camera(), config);
  EXPECT_TRUE(pair.same) << pair.reason;
  EXPECT_TRUE(pair.by_depth_alone);
  EXPECT_LT((pair.T_known_query.translation - kTrue.translation).norm(), 0.006);
  Appearance repainted = query;
  for (std::uint8_t& grey : repainted.small.grey.data) grey = static_cast<std::uint8_t>(255 - grey);
  const VerifiedPair other = verify_pair(known, repainted, kStart, small_camera(), config);
  EXPECT_FALSE(other.same);
  EXPECT_NE(other.reason.find("intensities correlate by -"), std::string::npos) << other.reason;
}

TEST(PlaceVerification, DepthRefinesThePoseOfFeatures) {
  const config::Config config;
  const Appearance known = appearance_at(kCorner, config);
  const Appearance query = appearance_at(kCorner * kTrue, config);
  const VerifiedPair pair = verify_pair(known, query, kStart, small_camera(), config);
  ASSERT_TRUE(pair.same) << pair.reason;
  EXPECT_FALSE(pair.by_depth_alone);
  EXPECT_LT((pair.T_known_query.translation - kTrue.translation).norm(), 0.004);
}

}  // namespace
}  // namespace fusebench
