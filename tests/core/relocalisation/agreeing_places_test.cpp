#include "core/relocalisation/agreeing_places.hpp"

#include <gtest/gtest.h>

#include "core/base/geometry.hpp"
#include "core/config/config.hpp"
#include "core/relocalisation/relocalisation.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace relocalisation;

namespace {

using config::Config;
using testing::small_camera;
using testing::TexturedRoom;

constexpr Config kDefaultConfig{};
constexpr std::int64_t kPeriod_ns = 33'000'000;
const Vector3d kSpeed_mps{0.4, -0.1, 0.2};
const Vector3d kTurn_radps{0.1, -0.5, 0.2};

AgreeingPlaces agreeing_places() {
  return {kDefaultConfig.relocalisation, kDefaultConfig.loops, kDefaultConfig.terms,
          kDefaultConfig.initialisation};
}

/// Where the camera is in frame k: a quiet motion.
SE3 truth_at(int k) {
  const double time_s = 1e-9 * static_cast<double>(k * kPeriod_ns);
  return {so3_exp(time_s * kTurn_radps), time_s * kSpeed_mps};
}

/// What a filter that is wrong by this rotation (of the world) and velocity predicts there.
SE3 predicted_at(int k, const Vector3d& turned_rad, const Vector3d& velocity_error_mps) {
  const SE3 truth = truth_at(k);
  const double time_s = 1e-9 * static_cast<double>(k * kPeriod_ns);
  return {so3_exp(turned_rad) * truth.rotation, truth.translation + time_s * velocity_error_mps};
}

RefusedPlace refused_at(int k, const SE3& T_world_imu, const SE3& T_world_imu_predicted) {
  RefusedPlace place;
  place.timestamp_ns = k * kPeriod_ns;
  place.pose.T_world_imu = T_world_imu;
  place.pose.covariance = 1e-5 * Matrix6d::Identity();
  place.T_world_imu_predicted = T_world_imu_predicted;
  return place;
}

/// Found right, by a filter that is wrong by 20 degrees and 3 m/s.
RefusedPlace right_place(int k) {
  return refused_at(k, truth_at(k), predicted_at(k, {0, 0.35, 0}, {3, 0, 0}));
}

TEST(AgreeingPlaces, ThatAreRightAreEnoughWhateverTheFilterClaims) {
  AgreeingPlaces places = agreeing_places();
  for (int k = 0; k < kDefaultConfig.relocalisation.agreeing_frames; ++k) {
    EXPECT_FALSE(places.are_enough()) << k;
    places.add(right_place(k));
  }
  EXPECT_TRUE(places.are_enough());
  places.clear();
  EXPECT_FALSE(places.are_enough());
}

TEST(AgreeingPlaces, OneThatIsElsewhereBeginsAnew) {
  for (const SE3& elsewhere : {SE3{Quaterniond::Identity(), {0.3, 0, 0}}, SE3{so3_exp({0, 0.1, 0}), {}}}) {
    AgreeingPlaces places = agreeing_places();
    for (int k = 0; k < 40; ++k) {
      RefusedPlace place = right_place(k);
      if (k % 4 == 3) place.pose.T_world_imu = elsewhere * place.pose.T_world_imu;
      places.add(place);
      EXPECT_FALSE(places.are_enough()) << k;
    }
  }
}

TEST(AgreeingPlaces, OfLongAgoDoNotCount) {
  AgreeingPlaces places = agreeing_places();
  for (int k = 0; k < 40; ++k) {
    places.add(right_place(20 * k));  // 0.66 s apart
    EXPECT_FALSE(places.are_enough()) << k;
  }
}

TEST(AgreeingPlaces, TheGyroscopeTellsHowFarTheyAreTurned) {
  // By a filter without an IMU nothing is known of the turn, so that two degrees a frame are possible.
  const RefusedPlace a = right_place(0);
  RefusedPlace b = right_place(1);
  b.pose.T_world_imu.rotation = b.pose.T_world_imu.rotation * so3_exp({0, 0.04, 0});
  EXPECT_LT(squared_disagreement(a, right_place(1), kDefaultConfig.terms, kDefaultConfig.initialisation),
            1.0);
  EXPECT_GT(squared_disagreement(a, b, kDefaultConfig.terms, kDefaultConfig.initialisation),
            kDefaultConfig.loops.agreeing_chi2);
  Config without = kDefaultConfig;
  without.terms.prior = config::Prior::constant_velocity;
  EXPECT_LT(squared_disagreement(a, b, without.terms, without.initialisation),
            kDefaultConfig.loops.agreeing_chi2);
}

TEST(AgreeingPlaces, TellTheMotionThatThePredictionHasLost) {
  AgreeingPlaces places = agreeing_places();
  filter::FilterState predicted;
  predicted.T_world_imu = predicted_at(3, {0, 0.35, 0}, {3, 0, 0});
  predicted.velocity_world_mps = {3, 0, 0};
  predicted.angular_velocity_imu_radps = kTurn_radps;
  places.add(right_place(0));
  EXPECT_FALSE(places.motion(kPeriod_ns, predicted));
  places.add(right_place(1));
  places.add(right_place(2));
  const auto motion = places.motion(3 * kPeriod_ns, predicted);
  ASSERT_TRUE(motion);
  EXPECT_LT((motion->velocity_world_mps - kSpeed_mps).norm(), 1e-9);
  EXPECT_LT(rotation_angle_rad(motion->T_world_imu.rotation, truth_at(3).rotation), 1e-9);
  EXPECT_EQ(motion->angular_velocity_imu_radps, kTurn_radps);
  EXPECT_FALSE(places.motion(30 * kPeriod_ns, predicted));  // of another time that the camera was lost
}

/// A camera that was lost, before a place that was fused: its filter claims a milliradian and a centimetre.
class ContradictedFilter : public ::testing::Test {
 protected:
  ContradictedFilter() {
    const RgbdFrame frame = room_.render(rig_.camera, {}, -kPeriod_ns);
    relocalisation_.add_keyframe(frame, {}, -kPeriod_ns, 0);
  }

  /// In frame k, whose depth is off by that much.
  std::optional<RelocalisedReference> find(int k, const Vector3d& turned_rad, float depth_error_m = 0,
                                           const Vector3d& moved_m = Vector3d::Zero()) {
    RgbdFrame frame = room_.render(rig_.camera, truth_at(k), k * kPeriod_ns);
    for (float& depth_m : frame.depth_m.data) depth_m += depth_error_m;
    filter::GaussianState prediction;
    prediction.mean.T_world_imu = predicted_at(k, turned_rad, Vector3d::Zero());
    prediction.mean.T_world_imu.translation += moved_m;
    prediction.covariance = 1e-6 * filter::StateMatrix::Identity();
    prediction.covariance.diagonal().segment<3>(filter::kRotation).setConstant(rotation_variance_rad2_);
    prediction.covariance.diagonal().segment<3>(filter::kPosition).setConstant(position_variance_m2_);
    return relocalisation_.find(frame, {}, prediction, model_, Workers(1));
  }

  double rotation_variance_rad2_ = 1e-6;
  double position_variance_m2_ = 1e-4;
  TexturedRoom room_;
  SensorRig rig_{small_camera(), {}, {}, {}};
  tsdf::TsdfVolume model_{kDefaultConfig.tsdf};
  Relocalisation relocalisation_{kDefaultConfig, rig_};
};

TEST_F(ContradictedFilter, BelievesSeveralFramesThatFindTheSamePlace) {
  const int frames = kDefaultConfig.relocalisation.agreeing_frames;
  for (int k = 0; k + 1 < frames; ++k) EXPECT_FALSE(find(k, {0, 0.4, 0})) << k;
  const auto found = find(frames - 1, {0, 0.4, 0});
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->by_depth);
  const SE3& T_world_imu = found->prior.mean.T_world_imu;
  EXPECT_LT(rotation_angle_rad(T_world_imu.rotation, truth_at(frames - 1).rotation), radians(1));
  EXPECT_LT((T_world_imu.translation - truth_at(frames - 1).translation).norm(), 0.02);
}

TEST_F(ContradictedFilter, IsNotOverruledBeyondAnyDrift) {
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(find(k, {0, 1.6, 0})) << k;
}

TEST_F(ContradictedFilter, IsNotOverruledByARotationThatIsNoDrift) {
  rotation_variance_rad2_ = 5e-5;  // either innovation is between the ordinary limit and the wider one
  for (int k = 0; k < 4; ++k) EXPECT_FALSE(find(k, {0, 0.5, 0})) << k;
  EXPECT_TRUE(find(4, {0, 0.5, 0}));
  for (int k = 5; k < 15; ++k) EXPECT_FALSE(find(k, {0, 0.7, 0})) << k;
}

TEST_F(ContradictedFilter, IsNotOverruledWhereDepthContradictsThePlace) {
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(find(k, {0, 0.4, 0}, 0.2F)) << k;
}

TEST_F(ContradictedFilter, IsNotOverruledWhereTheCameraCannotBe) {
  // Half a metre of the centimetre that it claims: as much as a rotation of 0.05 rad in all, which may be.
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(find(k, {0, 0.002, 0}, 0, {0.5, 0, 0})) << k;
}

TEST_F(ContradictedFilter, APlaceAsideIsRefusedWhateverItsRotationSays) {
  // Six degrees of freedom share an innovation that the position has alone: a picture that repeats on a wall.
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(find(k, {0, 0.002, 0}, 0, {0.2, 0, 0})) << k;
  EXPECT_TRUE(find(10, {0, 0.002, 0}, 0, {0.05, 0, 0}));
}

TEST_F(ContradictedFilter, BelievesNoneOfTwoPlacesThatLookAlike) {
  // Two metres aside hangs the same picture: a filter that claims a centimetre knows which it sees, one that
  // claims two metres does not.
  const RgbdFrame same = room_.render(rig_.camera, {}, -kPeriod_ns);
  relocalisation_.add_keyframe(same, {Quaterniond::Identity(), {2, 0, 0}}, 0, 0);
  EXPECT_TRUE(find(0, {0, 0.002, 0}));
  position_variance_m2_ = 4;
  for (int k = 1; k < 10; ++k) EXPECT_FALSE(find(k, {0, 0.002, 0})) << k;
}

TEST_F(ContradictedFilter, ThatDoesNotKnowWhereItIsBelievesSeveralFrames) {
  position_variance_m2_ = 4;
  for (int k = 0; k < 4; ++k) EXPECT_FALSE(find(k, {0, 0.002, 0})) << k;
  EXPECT_TRUE(find(4, {0, 0.002, 0}));
}

TEST_F(ContradictedFilter, ThatDoesNotKnowWhereItIsBelievesNoDepthThatContradictsThePlace) {
  position_variance_m2_ = 4;
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(find(k, {0, 0.002, 0}, 0.2F)) << k;
}

TEST_F(ContradictedFilter, IsBelievedWhereItIsRight) { EXPECT_TRUE(find(0, {0, 0.002, 0})); }

}  // namespace
}  // namespace fusebench
