#include "core/estimator/places/loops/loop_closure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/config/config.hpp"
#include "core/estimator/filter/moved_state.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "core/estimator/places/loops/loop_tables.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace loops;
using testing::small_camera;
using testing::TexturedRoom;

namespace {

constexpr int kFrames = 60;
constexpr int kLost = 45;  // the first frame that a tracker is lost in, in some tests
constexpr double kPeriod_s = 0.5;

/// Once around in the middle of the room: 12 places, and the last one is the first one again.
SE3 T_room_camera(int frame) {
  const double angle = 2 * std::numbers::pi * frame / (kFrames - 1);
  return {so3_exp({0, angle, 0}), {0.3 * std::sin(angle), 0, 0.3 * (1 - std::cos(angle))}};
}

/// The estimate turns by another degree and moves by another 4 cm until the end.
SE3 T_drift(int frame) {
  const double share = static_cast<double>(frame) / (kFrames - 1);
  return {so3_exp({0, share * radians(1.0), 0}), share * Vector3d(0.04, 0.01, 0)};
}

config::Config configuration(config::LoopMode mode) {
  config::Config config;
  config.loops.mode = mode;
  config.loops.query_every = 5;
  config.terms.prior = config::Prior::constant_velocity;
  return config;
}

std::int64_t stamp_ns(int frame) { return std::llround(1e9 * (100 + kPeriod_s * frame)); }

SensorRig rig() {
  SensorRig rig;
  rig.camera = small_camera();
  return rig;
}

/// The camera is the IMU; the filter claims the drift.
filter::GaussianState estimate_of(int frame, bool drifts) {
  filter::GaussianState estimate;
  const SE3 T_world_camera = (drifts ? T_drift(frame) : SE3{}) * T_room_camera(frame);
  estimate.mean.T_world_imu = estimate.mean.T_world_imu_reference = T_world_camera;
  const double share = (frame + 1.0) / kFrames;
  Vector6d variances;
  variances << Vector3d::Constant(share * 1e-4), Vector3d::Constant(share * 4e-4);
  estimate.covariance.topLeftCorner<filter::kPoseSize, filter::kPoseSize>() = variances.asDiagonal();
  return estimate;
}

void run(LoopClosure& loops, bool drifts, const std::vector<RgbdFrame>& frames) {
  for (int k = 0; k < kFrames; ++k) {
    const filter::GaussianState estimate = estimate_of(k, drifts);
    loops.add_fused(frames[static_cast<std::size_t>(k)], estimate, 0);
    loops.add_pose(stamp_ns(k), estimate.mean.T_world_imu);
  }
}

std::vector<RgbdFrame> rendered() {
  std::vector<RgbdFrame> frames;
  for (int k = 0; k < kFrames; ++k)
    frames.push_back(TexturedRoom{}.render(small_camera(), T_room_camera(k), stamp_ns(k)));
  return frames;
}

double error_m(const Trajectory& poses) {
  double sum = 0;
  for (int k = 0; k < kFrames; ++k) {
    const Vector3d& at = poses[static_cast<std::size_t>(k)].T_world_camera.translation;
    sum += (at - T_room_camera(k).translation).squaredNorm();
  }
  return std::sqrt(sum / kFrames);
}

int frame_of(const Place& place) {
  return static_cast<int>(std::lround((1e-9 * static_cast<double>(place.timestamp_ns) - 100) / kPeriod_s));
}

class Loops : public ::testing::Test {
 protected:
  static const std::vector<RgbdFrame>& frames() {
    static const std::vector<RgbdFrame> once = rendered();
    return once;
  }
  SensorRig rig_ = rig();
  config::Config config_final_ = configuration(config::LoopMode::final);
};

TEST_F(Loops, ComeTogetherWhereTheCameraComesBack) {
  const config::Config config = configuration(config::LoopMode::final);
  LoopClosure loops(config, rig_);
  run(loops, true, frames());
  const auto changed = loops.close();
  ASSERT_TRUE(changed) << changed.error().message;
  ASSERT_TRUE(*changed) << candidate_table(loops);
  Trajectory online;
  for (int k = 0; k < kFrames; ++k) online.push_back({stamp_ns(k), estimate_of(k, true).mean.T_world_imu});
  const Trajectory final = loops.corrected_trajectory();
  ASSERT_EQ(final.size(), online.size());
  EXPECT_LT((final.back().T_world_camera.translation - T_room_camera(kFrames - 1).translation).norm(), 0.01);
  EXPECT_LT(error_m(final), 0.6 * error_m(online));
  for (const LoopCandidate& candidate : loops.candidates()) {
    if (!candidate.accepted) continue;
    const auto room = [&](std::size_t place) { return T_room_camera(frame_of(loops.places()[place])); };
    const SE3 T_true = room(candidate.known).inverse() * room(candidate.query);
    EXPECT_LT((candidate.pair.T_known_query.translation - T_true.translation).norm(), 0.03);
  }
}

/// A tracker that is lost for a while finds itself by the first frame, which is right: it is not the time
/// that it was lost in which it drifted, but the path before.
TEST_F(Loops, ALostTrackerThatFindsItselfClosesOne) {
  config::Config config = configuration(config::LoopMode::final);
  config.loops.max_dissimilarity = 0.05;  // nothing else closes one
  config.loops.max_path_candidates = 0;
  constexpr int kFound = 50, kEnd = 56;
  for (const config::LoopMode mode : {config::LoopMode::detect, config::LoopMode::final}) {
    config.loops.mode = mode;
    LoopClosure loops(config, rig_);
    Trajectory online;
    for (int k = 0; k < kEnd; ++k) {
      if (k >= kLost && k < kFound) continue;
      const filter::GaussianState estimate = estimate_of(k, k < kLost);
      if (k == kFound) loops.add_relocalisation(estimate_of(k, true), estimate, stamp_ns(0));
      loops.add_fused(frames()[static_cast<std::size_t>(k)], estimate, 0);
      loops.add_pose(stamp_ns(k), estimate.mean.T_world_imu);
      online.push_back({stamp_ns(k), estimate.mean.T_world_imu});
    }
    const auto changed = loops.close();
    ASSERT_TRUE(changed) << changed.error().message;
    EXPECT_EQ(*changed, mode == config::LoopMode::final);
    const Trajectory final = loops.corrected_trajectory();
    ASSERT_EQ(final.size(), online.size());
    if (!*changed) {  // by self-relocalisation
      for (std::size_t k = 0; k < final.size(); ++k)
        EXPECT_LT(pose_minus(final[k].T_world_camera, online[k].T_world_camera).norm(), 1e-9) << k;
      continue;
    }
    const auto error_m = [](const StampedPose& pose, int frame) {
      return (pose.T_world_camera.translation - T_room_camera(frame).translation).norm();
    };
    EXPECT_LT(error_m(final.back(), kEnd - 1), 0.01);
    EXPECT_LT(error_m(final[kLost - 1], kLost - 1), 0.4 * error_m(online[kLost - 1], kLost - 1));
    EXPECT_EQ(std::ranges::count_if(loops.candidates(), &LoopCandidate::accepted), 1);
  }
}

/// The tracker is lost and relocalised in each of the last frames, none of which is fused (darkness): dead
/// reckoning has that error and claims it.
constexpr int kFoundInTheDark = 50, kEndInTheDark = 56;
const SE3 kAstray{so3_exp({0, 0.1, 0}), {0.5, 0, 0}};

void run_into_the_dark(LoopClosure& loops, const std::vector<RgbdFrame>& frames, std::int64_t found_by_ns) {
  for (int k = 0; k < kLost; ++k) {
    const filter::GaussianState estimate = estimate_of(k, true);
    loops.add_fused(frames[static_cast<std::size_t>(k)], estimate, 0);
    loops.add_pose(stamp_ns(k), estimate.mean.T_world_imu);
  }
  for (int k = kFoundInTheDark; k < kEndInTheDark; ++k) {
    const filter::GaussianState found = estimate_of(k, true);
    filter::GaussianState predicted = found;
    if (k == kFoundInTheDark) {
      predicted.mean.T_world_imu = kAstray * predicted.mean.T_world_imu;
      predicted.covariance.topLeftCorner<filter::kPoseSize, filter::kPoseSize>() +=
          covariance_by_axis(0.1, 0.5);
    }
    loops.add_relocalisation(predicted, found, found_by_ns);
    loops.add_pose(stamp_ns(k), found.mean.T_world_imu);
  }
}

/// Their poses follow that of the matched place, not dead reckoning.
TEST_F(Loops, RelocalisedFramesWithoutFusionMoveWithTheirPlace) {
  const config::Config config = configuration(config::LoopMode::final);
  LoopClosure loops(config, rig_);
  run_into_the_dark(loops, frames(), stamp_ns(kLost - 1));  // by the last place, which has drifted the most
  const std::size_t last = loops.places().size() - 1;
  const int found_by = frame_of(loops.places()[last]);
  const Trajectory before = loops.corrected_trajectory();
  for (std::size_t k = kLost; k < before.size(); ++k) {
    const int frame = kFoundInTheDark + static_cast<int>(k) - kLost;
    EXPECT_LT(pose_minus(before[k].T_world_camera, estimate_of(frame, true).mean.T_world_imu).norm(), 1e-9);
  }
  // A true loop from the first place to the last one before the dark takes the drift away.
  LoopCandidate loop;
  loop.query = last;
  loop.pair.same = true;
  loop.pair.T_known_query = T_room_camera(0).inverse() * T_room_camera(found_by);
  loop.pair.covariance = covariance_by_axis(1e-4, 1e-4);
  const auto after = loops.poses_with({loop});
  ASSERT_TRUE(after) << after.error().message;
  for (std::size_t k = kLost; k < after->size(); ++k) {
    const SE3 T_place_camera =
        before[static_cast<std::size_t>(found_by)].T_world_camera.inverse() * before[k].T_world_camera;
    const SE3 expected = (*after)[static_cast<std::size_t>(found_by)].T_world_camera * T_place_camera;
    EXPECT_LT(pose_minus((*after)[k].T_world_camera, expected).norm(), 1e-9) << k;
    EXPECT_GT(pose_minus((*after)[k].T_world_camera, before[k].T_world_camera).norm(), 1e-3) << k;
  }
}

/// Each of those frames is relocalised from the estimate of the previous one: dead reckoning adds no further
/// covariance.
TEST_F(Loops, CountsDeadReckoningOnceForSeveralRelocalisedFrames) {
  const config::Config config = configuration(config::LoopMode::detect);
  LoopClosure loops(config, rig_);
  run_into_the_dark(loops, frames(), stamp_ns(0));
  loops.add_fused(frames()[kEndInTheDark], estimate_of(kEndInTheDark, true), 0);
  const Matrix6d& lost = loops.places().back().lost_covariance;
  EXPECT_NEAR(std::sqrt(lost.topLeftCorner<3, 3>().trace() / 3), 0.1, 0.01);
}

/// Images and depth do not show that the two frames are of one place.
TEST_F(Loops, MarksEdgesOfTheTrackerAlone) {
  const config::Config config = configuration(config::LoopMode::detect);
  LoopClosure loops(config, rig_);
  loops.add_fused(frames().front(), estimate_of(0, false), 0);
  const filter::GaussianState found = estimate_of(30, false);  // opposite viewing direction
  loops.add_relocalisation(found, found, stamp_ns(0));
  loops.add_fused(frames()[30], found, 0);
  ASSERT_EQ(loops.candidates().size(), 1U);
  const LoopCandidate& candidate = loops.candidates().front();
  EXPECT_EQ(candidate.evidence, LoopEvidence::tracker_alone);
  testing::expect_contains(candidate_table(loops), ",tracker,accepted,");
}

TEST_F(Loops, DropsAFalseLoopThatOthersContradict) {
  const config::Config config = configuration(config::LoopMode::final);
  LoopClosure loops(config, rig_);
  run(loops, false, frames());
  const auto edge = [&](std::size_t known, std::size_t query, const SE3& T_true_false) {
    LoopCandidate candidate;
    candidate.known = known;
    candidate.query = query;
    candidate.pair.same = true;
    candidate.pair.T_known_query =
        loops.places()[known].T_world_camera.inverse() * loops.places()[query].T_world_camera * T_true_false;
    candidate.pair.covariance = covariance_by_axis(0.001, 0.001);
    return candidate;
  };
  const std::size_t last = loops.places().size() - 1;
  const std::vector<LoopCandidate> right = {edge(0, last, {}), edge(1, last, {}), edge(0, last - 1, {})};
  std::vector<LoopCandidate> with_false = right;
  with_false.push_back(edge(1, last - 1, {Quaterniond::Identity(), {0.3, 0, 0}}));
  const auto expected = loops.poses_with(right);
  const auto poses = loops.poses_with(with_false);
  ASSERT_TRUE(expected && poses);
  for (std::size_t k = 0; k < poses->size(); ++k)
    EXPECT_EQ((*poses)[k].T_world_camera.translation, (*expected)[k].T_world_camera.translation) << k;
}

/// Camera pose of the estimate a moment later.
SE3 T_world_camera_after(const filter::GaussianState& estimate, const SensorRig& rig, double dt_s) {
  const filter::FilterState& s = estimate.mean;
  const SE3 T_world_imu{s.T_world_imu.rotation * so3_exp(dt_s * s.angular_velocity_imu_radps),
                        s.T_world_imu.translation + dt_s * s.velocity_world_mps};
  return T_world_imu * rig.T_imu_camera;
}

TEST_F(Loops, AnErrorOfTheInstantIsAlongTheMotion) {
  SensorRig rig = rig_;
  rig.T_imu_camera = {so3_exp({0.3, -0.2, 0.5}), {0.1, -0.05, 0.2}};
  const auto estimate_at = [&](int frame) {
    filter::GaussianState estimate = estimate_of(frame, true);
    estimate.mean.T_world_imu = estimate.mean.T_world_imu * rig.T_imu_camera.inverse();
    estimate.mean.velocity_world_mps = Vector3d(0.4, -0.3, 0.01 * frame);
    estimate.mean.angular_velocity_imu_radps = Vector3d(0.2, 3 - 0.02 * frame, -0.5);
    return estimate;
  };
  config::Config config = configuration(config::LoopMode::detect);
  config::Config without = config;
  config.loops.timing_sigma_s = 0.004;
  without.loops.timing_sigma_s = 0;
  LoopClosure loops(config, rig);
  LoopClosure exact(without, rig);
  for (int k = 0; k < kFrames; ++k) {
    loops.add_fused(frames()[static_cast<std::size_t>(k)], estimate_at(k), 0);
    exact.add_fused(frames()[static_cast<std::size_t>(k)], estimate_at(k), 0);
  }
  const auto found = std::ranges::find_if(loops.candidates(), [](const auto& c) { return c.pair.same; });
  ASSERT_NE(found, loops.candidates().end());
  const auto estimate_of_place = [&](std::size_t place) {
    return estimate_at(frame_of(loops.places()[place]));
  };
  constexpr double kStep_s = 1e-4;
  const filter::GaussianState known = estimate_of_place(found->known);
  const filter::GaussianState query = estimate_of_place(found->query);
  const auto moved = [&](double known_s, double query_s) {
    const SE3 from_known =
        T_world_camera_after(known, rig, known_s).inverse() * T_world_camera_after(known, rig, 0);
    const SE3 to_query =
        T_world_camera_after(query, rig, 0).inverse() * T_world_camera_after(query, rig, query_s);
    return Vector6d(pose_minus(from_known * found->pair.T_known_query * to_query, found->pair.T_known_query) /
                    kStep_s);
  };
  const Vector6d by_known = moved(kStep_s, 0);
  const Vector6d by_query = moved(0, kStep_s);
  const Matrix6d expected =
      0.004 * 0.004 * (by_known * by_known.transpose() + by_query * by_query.transpose());
  const Matrix6d added = loops.covariance_of(*found) - exact.covariance_of(*found);
  EXPECT_LT((added - expected).norm(), 2e-3 * expected.norm()) << added << "\n\n" << expected;
}

/// Without similar appearance (darkness), the candidates follow from the current poses.
TEST_F(Loops, ThePathLeadsToPlacesThatAppearanceDoesNotFind) {
  config::Config config = configuration(config::LoopMode::final);
  config.loops.max_dissimilarity = 0.05;
  config.loops.max_path_candidates = 0;
  LoopClosure by_appearance(config, rig_);
  run(by_appearance, true, frames());
  ASSERT_FALSE(by_appearance.close().value()) << candidate_table(by_appearance);
  config.loops.max_path_candidates = 3;
  LoopClosure by_path(config, rig_);
  run(by_path, true, frames());
  ASSERT_TRUE(by_path.close().value()) << candidate_table(by_path);
  EXPECT_LT((by_path.corrected_trajectory().back().T_world_camera.translation -
             T_room_camera(kFrames - 1).translation)
                .norm(),
            0.01);
}

TEST_F(Loops, AStateIsCorrectedAsItsPoseIs) {
  const config::Config config = configuration(config::LoopMode::final);
  LoopClosure loops(config, rig_);
  run(loops, true, frames());
  ASSERT_TRUE(loops.close().value());
  const Trajectory final = loops.corrected_trajectory();
  const auto state = loops.corrected_state(stamp_ns(kFrames - 1));
  ASSERT_TRUE(state);
  EXPECT_LT((state->T_world_imu.translation - final.back().T_world_camera.translation).norm(), 1e-12);
  EXPECT_FALSE(loops.corrected_state(stamp_ns(3) + 1)) << "no frame of that stamp was fused";
}

/// The estimate moves along as a caller's does.
TEST_F(Loops, OnlineCorrectsTheFrameOfTheEstimate) {
  config::Config config = configuration(config::LoopMode::online);
  config.loops.online_every = 20;
  LoopClosure loops(config, rig_);
  SE3 T_current_drifted;
  int corrections = 0;
  Trajectory online;
  for (int k = 0; k < kFrames; ++k) {
    filter::GaussianState estimate = estimate_of(k, true);
    estimate = filter::moved(estimate, T_current_drifted);
    loops.add_fused(frames()[static_cast<std::size_t>(k)], estimate, 0);
    loops.add_pose(stamp_ns(k), estimate.mean.T_world_imu);
    online.push_back({stamp_ns(k), estimate.mean.T_world_imu});
    const auto moved = loops.correct_online();
    ASSERT_TRUE(moved) << moved.error().message;
    if (!*moved) continue;
    ++corrections;
    T_current_drifted = **moved * T_current_drifted;
    const SE3 T_now = T_current_drifted * estimate_of(k, true).mean.T_world_imu;
    const auto error_of = [&](const SE3& pose) {
      return (pose.translation - T_room_camera(k).translation).norm();
    };
    EXPECT_LT(error_of(T_now), 0.6 * error_of(estimate.mean.T_world_imu));
    EXPECT_LT((loops.corrected_pose_near(stamp_ns(k)).translation - T_now.translation).norm(), 1e-9);
  }
  EXPECT_GE(corrections, 1);
  ASSERT_TRUE(loops.close().value());
  EXPECT_LT(error_m(loops.corrected_trajectory()), 0.6 * error_m(online));
  // Edges between places do not depend on online corrections.
  LoopClosure at_the_end(config_final_, rig_);
  run(at_the_end, true, frames());
  ASSERT_TRUE(at_the_end.close().value());
  for (std::size_t k = 0; k < online.size(); ++k)
    EXPECT_LT((loops.corrected_trajectory()[k].T_world_camera.translation -
               at_the_end.corrected_trajectory()[k].T_world_camera.translation)
                  .norm(),
              1e-4);
}

TEST_F(Loops, DetectionChangesNothing) {
  const config::Config config = configuration(config::LoopMode::detect);
  LoopClosure loops(config, rig_);
  run(loops, true, frames());
  EXPECT_FALSE(loops.close().value());
  EXPECT_NE(candidate_table(loops).find("accepted"), std::string::npos);
  EXPECT_EQ(loops.corrected_trajectory().back().T_world_camera.translation,
            estimate_of(kFrames - 1, true).mean.T_world_imu.translation);
}

TEST_F(Loops, OffKeepsNothing) {
  const config::Config config = configuration(config::LoopMode::off);
  LoopClosure loops(config, rig_);
  run(loops, true, frames());
  EXPECT_FALSE(loops.close().value());
  EXPECT_TRUE(loops.places().empty());
  EXPECT_TRUE(candidate_table(loops).empty());
}

/// Two rooms that look alike: all features and all depth agree, and the place is another one.
TEST_F(Loops, AppearanceAloneMovesNothing) {
  const config::Config config = configuration(config::LoopMode::final);
  LoopClosure loops(config, rig_);
  // One frame of the first room is seen again 6 m away, and nothing around it supports that.
  std::vector<RgbdFrame> seen = frames();
  for (int k = 0; k < kFrames; ++k) {
    filter::GaussianState estimate = estimate_of(k, false);
    const int twin = kFrames - 3;
    if (k > kFrames / 2) estimate.mean.T_world_imu.translation += Vector3d(6, 0, 0);
    if (k > kFrames / 2 && k != twin) continue;
    const std::size_t shown = k == twin ? 2 : static_cast<std::size_t>(k);
    RgbdFrame frame = seen[shown];
    frame.timestamp_ns = stamp_ns(k);
    loops.add_fused(frame, estimate, 0);
    loops.add_pose(stamp_ns(k), estimate.mean.T_world_imu);
  }
  ASSERT_FALSE(loops.close().value()) << candidate_table(loops);
  EXPECT_NE(candidate_table(loops).find("contradicts the poses"), std::string::npos)
      << candidate_table(loops);
}

TEST_F(Loops, WithoutDriftPosesStay) {
  const config::Config config = configuration(config::LoopMode::final);
  LoopClosure loops(config, rig_);
  run(loops, false, frames());
  ASSERT_TRUE(loops.close().value());
  EXPECT_LT(error_m(loops.corrected_trajectory()), 0.01);
}

}  // namespace
}  // namespace fusebench
