#include "eval/metrics/loop_error/loop_error.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/config/config.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace loop_error;
using testing::small_camera;
using testing::TexturedRoom;

namespace {

/// Towards two corners of the room in turn: three places 10 s apart, of which the last is the first again.
const std::array<SE3, 3> kTruth = {SE3{so3_exp({-0.45, 0.6, 0}), {0, 0, 0}},
                                   SE3{so3_exp({-0.45, -0.9, 0}), {0.2, 0, 0}},
                                   SE3{so3_exp({-0.45, 0.62, 0}), {0.03, 0, 0.02}}};
const Vector3d kDrift_m{0.03, 0, 0};  // of the last place

std::int64_t stamp_ns(std::size_t place) {
  return std::llround(1e9 * (100 + 10.0 * static_cast<double>(place)));
}

Trajectory truth() {
  Trajectory poses;
  for (std::size_t k = 0; k < kTruth.size(); ++k) poses.push_back({stamp_ns(k), kTruth[k]});
  return poses;
}

class LoopErrors : public ::testing::Test {
 protected:
  LoopErrors() {
    rig_.camera = small_camera();
    config_.loops.mode = config::LoopMode::final;
    config_.loops.query_every = 1;
    config_.loops.least_age_s = 15;
    config_.terms.prior = config::Prior::constant_velocity;
  }

  /// blur_px: of the last place.
  loops::LoopClosure closed(double blur_px = 0) {
    loops::LoopClosure closure(config_, rig_);
    for (std::size_t k = 0; k < kTruth.size(); ++k) {
      filter::GaussianState estimate;
      estimate.mean.T_world_imu = kTruth[k];
      if (k == 2) estimate.mean.T_world_imu.translation += kDrift_m;
      const double variance = 1e-4 * (1 + static_cast<double>(k));
      estimate.covariance.topLeftCorner<filter::kPoseSize, filter::kPoseSize>() =
          variance * Matrix6d::Identity();
      closure.add_fused(TexturedRoom{}.render(rig_.camera, kTruth[k], stamp_ns(k)), estimate,
                        k == 2 ? blur_px : 0.0);
      closure.add_pose(stamp_ns(k), estimate.mean.T_world_imu);
    }
    EXPECT_TRUE(closure.close().value());
    return closure;
  }

  SensorRig rig_;
  config::Config config_;
};

TEST_F(LoopErrors, AReturnThatIsFoundIsTrueAndWhatItIsWorthIsKnown) {
  const auto error = loop_error::loop_error(closed(), truth(), rig_.camera, config_.depth, config_.loops);
  ASSERT_TRUE(error) << error.error().message;
  EXPECT_EQ(error->places, 3U);
  EXPECT_EQ(error->sharp.count, 1U);
  EXPECT_EQ(error->sharp.found, 1U);
  EXPECT_EQ(error->blurred.count, 0U);
  EXPECT_EQ(error->accepted, 1U);
  EXPECT_EQ(error->false_accepted, 0U);
  EXPECT_LT(error->median_translation_m, 0.02);
  EXPECT_LT(error->median_rotation_rad, radians(1.0));
  ASSERT_TRUE(error->oracle_ate_m);
  EXPECT_LT(*error->oracle_ate_m, 0.5 * kDrift_m.norm());
}

TEST_F(LoopErrors, ConsistencyIsTheNormalisedErrorByDegreeOfFreedom) {
  Trajectory off = truth();
  off.back().T_world_camera =
      off.back().T_world_camera * SE3{so3_exp({0.004, -0.006, 0.002}), {0.02, 0.01, 0.03}};
  const loops::LoopClosure closure = closed();
  const auto error = loop_error::loop_error(closure, off, rig_.camera, config_.depth, config_.loops);
  ASSERT_TRUE(error) << error.error().message;
  ASSERT_EQ(error->accepted, 1U);
  for (const loops::LoopCandidate& candidate : closure.candidates()) {
    if (!candidate.accepted) continue;
    const SE3 T_true = off[candidate.known].T_world_camera.inverse() * off[candidate.query].T_world_camera;
    const Matrix6d covariance = closure.covariance_of(candidate);
    const Vector3d turn = so3_log(T_true.rotation.conjugate() * candidate.pair.T_known_query.rotation);
    const Vector3d shift = candidate.pair.T_known_query.translation - T_true.translation;
    const auto mean_square = [](const Vector3d& e, const Matrix3d& C) { return e.dot(C.inverse() * e) / 3; };
    EXPECT_NEAR(error->nees_rotation / mean_square(turn, covariance.topLeftCorner<3, 3>()), 1.0, 1e-6);
    EXPECT_NEAR(error->nees_position / mean_square(shift, covariance.bottomRightCorner<3, 3>()), 1.0, 1e-6);
  }
}

TEST_F(LoopErrors, BlurIsCountedApart) {
  const auto error = loop_error::loop_error(closed(5), truth(), rig_.camera, config_.depth, config_.loops);
  ASSERT_TRUE(error) << error.error().message;
  EXPECT_EQ(error->sharp.count, 0U);
  EXPECT_EQ(error->blurred.count, 1U);
}

/// The same images, but the truth has the last place in another room.
TEST_F(LoopErrors, ALoopToAnotherPlaceIsFalse) {
  Trajectory elsewhere = truth();
  elsewhere.back().T_world_camera.translation += Vector3d(5, 0, 0);
  const auto error = loop_error::loop_error(closed(), elsewhere, rig_.camera, config_.depth, config_.loops);
  ASSERT_TRUE(error) << error.error().message;
  EXPECT_EQ(error->sharp.count, 0U) << "there is no return to be found";
  EXPECT_EQ(error->accepted, 1U);
  EXPECT_EQ(error->false_accepted, 1U);
  EXPECT_FALSE(error->oracle_ate_m);
}

TEST_F(LoopErrors, PlacesInGapsOfTheTruthAreLeftOut) {
  Trajectory gap = truth();
  gap.pop_back();
  const auto error = loop_error::loop_error(closed(), gap, rig_.camera, config_.depth, config_.loops);
  ASSERT_TRUE(error) << error.error().message;
  EXPECT_EQ(error->places, 2U);
  EXPECT_EQ(error->verified, 0U);
  EXPECT_EQ(error->accepted, 0U);
}

}  // namespace
}  // namespace fusebench
