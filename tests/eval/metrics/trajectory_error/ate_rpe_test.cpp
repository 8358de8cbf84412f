#include "eval/metrics/trajectory_error/ate_rpe.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "eval/metrics/trajectory_files/stamps.hpp"

namespace fusebench {

using namespace trajectory_files;
using namespace trajectory_error;

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// A smooth, twisting path at 30 Hz.
Trajectory wavy_path(std::size_t poses, std::int64_t start_ns = 1305031102 * kSecond) {
  Trajectory path;
  for (std::size_t i = 0; i < poses; ++i) {
    const double t = static_cast<double>(i) / 30.0;
    SE3 pose;
    pose.translation = {std::sin(t), 0.5 * std::cos(1.3 * t), 0.2 * t + 0.1 * std::sin(2.1 * t)};
    pose.rotation = so3_exp({0.3 * std::sin(0.7 * t), 0.4 * t, 0.2 * std::cos(t)});
    path.push_back({start_ns + static_cast<std::int64_t>(i) * kSecond / 30, pose});
  }
  return path;
}

/// The same path with small smooth errors.
Trajectory disturbed(const Trajectory& path) {
  Trajectory result = path;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double phase = static_cast<double>(i);
    const SE3 error{so3_exp({0.01 * std::sin(phase), 0.005 * std::cos(0.5 * phase), 0.002}),
                    {0.01 * std::cos(phase), 0.02 * std::sin(0.3 * phase), 0.005 * std::sin(phase)}};
    result[i].T_world_camera = result[i].T_world_camera * error;
  }
  return result;
}

Trajectory moved(const SE3& T_other_world, Trajectory path) {
  for (StampedPose& pose : path) pose.T_world_camera = T_other_world * pose.T_world_camera;
  return path;
}

const SE3 kSomewhere{so3_exp({0.4, -1.1, 2.0}), {3.0, -7.0, 0.5}};

TEST(Ate, ByHand) {
  // Four corners of a square; two opposite corners are lifted by +h and two by -h: no rigid motion helps
  // (symmetry), so every error is h.
  Trajectory truth(4);
  Trajectory estimate(4);
  const double h = 0.05;
  const std::vector<Vector3d> corners = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    truth[i].timestamp_ns = estimate[i].timestamp_ns = static_cast<std::int64_t>(i) * kSecond;
    truth[i].T_world_camera.translation = corners[i];
    estimate[i].T_world_camera.translation = corners[i] + Vector3d(0, 0, i % 2 == 0 ? h : -h);
  }
  const auto ate = absolute_trajectory_error(truth, estimate);
  ASSERT_TRUE(ate.has_value()) << ate.error().message;
  EXPECT_NEAR(ate->stats.rmse, h, 1e-12);
  EXPECT_NEAR(ate->stats.std, 0, 1e-12);
  EXPECT_EQ(ate->pairs, 4U);
  EXPECT_EQ(ate->alignment.mode, "se3");
}

TEST(Ate, RecoversAPlantedTransform) {
  const Trajectory truth = wavy_path(200);
  const auto ate = absolute_trajectory_error(moved(kSomewhere, truth), truth);
  ASSERT_TRUE(ate.has_value());
  EXPECT_LT(ate->stats.max, 1e-12);
  EXPECT_LT(rotation_angle_rad(ate->alignment.T_reference_estimate.rotation, kSomewhere.rotation), 1e-12);
  EXPECT_LT((ate->alignment.T_reference_estimate.translation - kSomewhere.translation).norm(), 1e-11);
}

TEST(Ate, DoesNotChangeWithRigidMotionOfEitherSide) {
  const Trajectory truth = wavy_path(200);
  const Trajectory estimate = disturbed(truth);
  const double rmse = absolute_trajectory_error(truth, estimate)->stats.rmse;
  EXPECT_GT(rmse, 1e-3);
  EXPECT_NEAR(absolute_trajectory_error(moved(kSomewhere, truth), estimate)->stats.rmse, rmse, 1e-12);
  EXPECT_NEAR(absolute_trajectory_error(truth, moved(kSomewhere, estimate))->stats.rmse, rmse, 1e-12);
}

TEST(Ate, NoOtherAlignmentIsBetter) {
  const Trajectory truth = wavy_path(100);
  const Trajectory estimate = disturbed(truth);
  const auto ate = absolute_trajectory_error(truth, estimate);
  ASSERT_TRUE(ate.has_value());
  for (int axis = 0; axis < 6; ++axis) {
    for (const double step : {-1e-3, 1e-3}) {
      Vector6d delta = Vector6d::Zero();
      delta[axis] = step;
      const SE3 other = ate->alignment.T_reference_estimate * SE3{so3_exp(delta.head<3>()), delta.tail<3>()};
      double sse = 0;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        sse += (other * estimate[i].T_world_camera.translation - truth[i].T_world_camera.translation)
                   .squaredNorm();
      }
      EXPECT_GT(sse, ate->stats.sse);
    }
  }
}

TEST(Ate, GroundTruthIsFoundByTimeNotByPosition) {
  const Trajectory truth = wavy_path(300);
  Trajectory estimate(truth.begin() + 100, truth.begin() + 200);
  const auto ate = absolute_trajectory_error(truth, estimate);
  ASSERT_TRUE(ate.has_value());
  EXPECT_EQ(ate->pairs, 100U);
  EXPECT_LT(ate->stats.max, 1e-12);
}

TEST(Ate, CoverageCountsFramesThatWereAskedFor) {
  const Trajectory truth = wavy_path(100);
  const Trajectory estimate(truth.begin(), truth.begin() + 40);  // died early
  const std::vector<std::int64_t> expected = stamps_of(truth);
  AteOptions options;
  options.expected_ns = expected;
  const auto ate = absolute_trajectory_error(truth, estimate, options);
  ASSERT_TRUE(ate.has_value());
  EXPECT_EQ(ate->pairs, 40U);
  EXPECT_EQ(ate->possible, 100U);
  EXPECT_DOUBLE_EQ(ate->coverage, 0.4);
}

TEST(Ate, DegenerateInputIsATypedError) {
  const Trajectory truth = wavy_path(50);
  const auto code_of = [](const Result<AteResult>& result) {
    EXPECT_FALSE(result.has_value());
    return result.error().code;
  };
  EXPECT_EQ(code_of(absolute_trajectory_error(truth, {})), ErrorCode::data_corrupt);
  EXPECT_EQ(code_of(absolute_trajectory_error({}, truth)), ErrorCode::data_corrupt);
  EXPECT_EQ(code_of(absolute_trajectory_error(truth, Trajectory(truth.begin(), truth.begin() + 2))),
            ErrorCode::data_corrupt);
  EXPECT_EQ(code_of(absolute_trajectory_error(truth, wavy_path(50, 0))), ErrorCode::data_corrupt);
  Trajectory line = truth;
  for (std::size_t i = 0; i < line.size(); ++i) {
    line[i].T_world_camera.translation = static_cast<double>(i) * Vector3d(0.1, 0.27, -0.13);
  }
  EXPECT_EQ(code_of(absolute_trajectory_error(line, line)), ErrorCode::data_corrupt);
  Trajectory still = truth;
  for (StampedPose& pose : still) pose.T_world_camera.translation = {1, 2, 3};
  EXPECT_EQ(code_of(absolute_trajectory_error(truth, still)), ErrorCode::data_corrupt);
}

TEST(Ate, WhoeverDoesNotMoveIsNamed) {
  const Trajectory path = wavy_path(20);
  Trajectory still = path;
  for (std::size_t i = 0; i < still.size(); ++i)
    still[i].T_world_camera.translation = Vector3d(1, 2, 3) + static_cast<double>(i) * Vector3d(1e-17, 0, 0);
  const auto at_rest = absolute_trajectory_error(still, path);
  ASSERT_FALSE(at_rest);
  EXPECT_NE(at_rest.error().message.find("the reference does not move: its 20 matched positions extend over"),
            std::string::npos)
      << at_rest.error().message;
  const auto stuck = absolute_trajectory_error(path, still);
  ASSERT_FALSE(stuck);
  EXPECT_NE(stuck.error().message.find("the estimate does not move"), std::string::npos);
}

TEST(Ate, AReflectionIsNotAnAlignment) {
  Trajectory truth = wavy_path(100);
  Trajectory mirrored = truth;
  for (StampedPose& pose : mirrored) pose.T_world_camera.translation.x() *= -1;
  const auto ate = absolute_trajectory_error(truth, mirrored);
  ASSERT_TRUE(ate.has_value());
  EXPECT_NEAR(ate->alignment.T_reference_estimate.rotation_matrix().determinant(), 1.0, 1e-12);
  EXPECT_GT(ate->stats.rmse, 0.01);
}

TEST(Rpe, ByHandConstantDriftPerFrame) {
  // Truth moves 10 cm a frame along z, the estimate 11 cm: 1 cm a frame, 0.3 m over 1 s.
  Trajectory truth(100);
  Trajectory estimate(100);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    truth[i].timestamp_ns = estimate[i].timestamp_ns = static_cast<std::int64_t>(i) * kSecond / 30;
    truth[i].T_world_camera.translation = {0, 0, 0.1 * static_cast<double>(i)};
    estimate[i].T_world_camera.translation = {0, 0, 0.11 * static_cast<double>(i)};
  }
  const auto frame = relative_pose_error(truth, estimate, {.delta = 1, .unit = DeltaUnit::frames});
  ASSERT_TRUE(frame.has_value()) << frame.error().message;
  EXPECT_NEAR(frame->translation.rmse, 0.01, 1e-12);
  EXPECT_EQ(frame->pairs, 98U);  // 99 pairs, and the one that ends at the last pose is dropped
  const auto second = relative_pose_error(truth, estimate, {.delta = 1, .unit = DeltaUnit::seconds});
  ASSERT_TRUE(second.has_value());
  EXPECT_NEAR(second->translation.rmse, 0.3, 1e-12);
  EXPECT_NEAR(second->rotation.rmse, 0.0, 1e-12);
}

TEST(Rpe, RecoversAPlantedRotation) {
  // The estimate turns by an additional angle each frame about the camera's own axis.
  const double angle = 0.5 * std::numbers::pi / 180;
  Trajectory truth = wavy_path(100);
  Trajectory estimate = truth;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    estimate[i].T_world_camera.rotation = truth[i].T_world_camera.rotation =
        so3_exp(Vector3d(0, 0.02 * static_cast<double>(i), 0));
    estimate[i].T_world_camera.rotation =
        estimate[i].T_world_camera.rotation * so3_exp(Vector3d(0, angle * static_cast<double>(i), 0));
  }
  const auto rpe = relative_pose_error(truth, estimate, {.delta = 1, .unit = DeltaUnit::frames});
  ASSERT_TRUE(rpe.has_value());
  EXPECT_NEAR(rpe->rotation.min, angle, 1e-12);
  EXPECT_NEAR(rpe->rotation.max, angle, 1e-12);
}

TEST(Rpe, DoesNotChangeWithRigidMotionOfEitherSide) {
  const Trajectory truth = wavy_path(200);
  const Trajectory estimate = disturbed(truth);
  const auto base = relative_pose_error(truth, estimate);
  ASSERT_TRUE(base.has_value());
  const auto truth_moved = relative_pose_error(moved(kSomewhere, truth), estimate);
  const auto estimate_moved = relative_pose_error(truth, moved(kSomewhere, estimate));
  EXPECT_NEAR(truth_moved->translation.rmse, base->translation.rmse, 1e-12);
  EXPECT_NEAR(estimate_moved->translation.rmse, base->translation.rmse, 1e-12);
  EXPECT_NEAR(estimate_moved->rotation.rmse, base->rotation.rmse, 1e-12);
}

TEST(Rpe, AMissingFrameIsSkippedNotChained) {
  const Trajectory truth = wavy_path(100);
  Trajectory estimate = truth;
  estimate.erase(estimate.begin() + 50);
  const auto rpe = relative_pose_error(truth, estimate, {.delta = 1, .unit = DeltaUnit::frames});
  ASSERT_TRUE(rpe.has_value());
  EXPECT_EQ(rpe->possible, 96U);  // 98 neighbours, less the gap, less the pair at the end
  const auto chained =
      relative_pose_error(truth, estimate, {.delta = 1, .unit = DeltaUnit::frames, .skip_gaps = false});
  EXPECT_EQ(chained->possible, 97U);
}

// evaluate_rpe.py: find_closest_index(stamps, stamps[i] + delta) is i itself where the next pose is later
// than two deltas.
TEST(Rpe, APoseIsNotItsOwnPartner) {
  const Trajectory truth = wavy_path(400);
  Trajectory estimate = disturbed(truth);
  estimate.erase(estimate.begin() + 180, estimate.begin() + 290);  // 3.7 s
  for (const DeltaUnit unit : {DeltaUnit::seconds, DeltaUnit::metres, DeltaUnit::radians}) {
    const RpeOptions as_script{.delta = 0.3, .unit = unit, .skip_gaps = false};
    const auto script = relative_pose_error(truth, estimate, as_script);
    RpeOptions left_out = as_script;
    left_out.skip_itself = true;
    const auto verb = relative_pose_error(truth, estimate, left_out);
    const auto record = relative_pose_error(truth, estimate, {.delta = 0.3, .unit = unit});
    ASSERT_TRUE(script.has_value() && verb.has_value() && record.has_value());
    const auto zeros = [](const RpeResult& rpe) { return std::ranges::count(rpe.errors_m, 0.0); };
    EXPECT_GT(zeros(*script), 0);
    EXPECT_EQ(zeros(*verb), 0);
    EXPECT_EQ(verb->possible + verb->with_itself, script->possible);
    EXPECT_EQ(static_cast<std::ptrdiff_t>(verb->with_itself), zeros(*script));
    EXPECT_EQ(verb->errors_m, record->errors_m);
    EXPECT_EQ(verb->errors_rad, record->errors_rad);
    EXPECT_GT(record->translation.rmse, script->translation.rmse);
  }
}

TEST(Rpe, PairsWithoutGroundTruthAreCounted) {
  Trajectory truth = wavy_path(200);
  const Trajectory estimate = truth;
  truth.erase(truth.begin() + 50, truth.begin() + 80);
  const auto rpe = relative_pose_error(truth, estimate, {.delta = 1, .unit = DeltaUnit::frames});
  ASSERT_TRUE(rpe.has_value());
  EXPECT_EQ(rpe->possible, 198U);
  EXPECT_EQ(rpe->pairs, 198U - 31U);
  EXPECT_LT(rpe->translation.max, 1e-12);
}

TEST(Rpe, GroundTruthCountsWithinTwiceItsMedianInterval) {
  Trajectory truth;
  for (int i = 0; i < 200; ++i)
    truth.push_back({i * 8'000'000LL, {so3_exp({0, 0.001 * i, 0}), {0.01 * i, 0, 0}}});
  // Two missing poses leave 12 ms on either side of the middle of the gap, four leave 20 ms.
  for (const auto& [missing, is_near] : {std::pair{2, true}, std::pair{4, false}}) {
    Trajectory gap = truth;
    gap.erase(gap.begin() + 100, gap.begin() + 100 + missing);
    Trajectory estimate = gap;
    StampedPose between = gap[99];
    between.timestamp_ns = (gap[99].timestamp_ns + gap[100].timestamp_ns) / 2;
    estimate.insert(estimate.begin() + 100, between);
    const auto rpe =
        relative_pose_error(gap, estimate, {.delta = 1, .unit = DeltaUnit::frames, .skip_gaps = false});
    ASSERT_TRUE(rpe.has_value());
    EXPECT_EQ(rpe->possible - rpe->pairs, is_near ? 0U : 2U) << missing;
  }
}

TEST(Rpe, DegenerateInputIsATypedError) {
  const Trajectory truth = wavy_path(60);
  EXPECT_EQ(relative_pose_error(truth, {}).error().code, ErrorCode::data_corrupt);
  EXPECT_EQ(relative_pose_error({}, truth).error().code, ErrorCode::data_corrupt);
  EXPECT_EQ(relative_pose_error(truth, wavy_path(60, 0)).error().code, ErrorCode::data_corrupt);
  EXPECT_EQ(relative_pose_error(truth, Trajectory(truth.begin(), truth.begin() + 10)).error().code,
            ErrorCode::data_corrupt);  // shorter than delta
  EXPECT_EQ(relative_pose_error(truth, truth, {.delta = 1.5, .unit = DeltaUnit::frames}).error().code,
            ErrorCode::configuration);
  EXPECT_EQ(relative_pose_error(truth, truth, {.delta = -1}).error().code, ErrorCode::configuration);
  EXPECT_EQ(relative_pose_error(truth, truth, {.delta = std::nan("")}).error().code,
            ErrorCode::configuration);
}

}  // namespace
}  // namespace fusebench
