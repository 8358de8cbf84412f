#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/metrics/trajectory_error/segment_errors.hpp"

namespace fusebench {

using namespace trajectory_files;
using namespace trajectory_error;

namespace {

/// A camera that drives a wide curve: one pose every tenth of a second, path_m further each.
Trajectory curve(std::size_t poses, double step_m) {
  Trajectory trajectory;
  SE3 T_world_camera;
  for (std::size_t i = 0; i < poses; ++i) {
    trajectory.push_back({static_cast<std::int64_t>(i) * 100'000'000, T_world_camera});
    T_world_camera = T_world_camera * SE3{so3_exp(Vector3d(0, 0, 0.01)), Vector3d(step_m, 0, 0)};
  }
  return trajectory;
}

/// The same with every motion too long by a share, and turned by an angle too much about z.
Trajectory drifting(const Trajectory& truth, double share, double turn_rad) {
  Trajectory trajectory;
  SE3 T_world_camera;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    trajectory.push_back({truth[i].timestamp_ns, T_world_camera});
    if (i + 1 == truth.size()) break;
    SE3 motion = truth[i].T_world_camera.inverse() * truth[i + 1].T_world_camera;
    motion.translation *= 1 + share;
    T_world_camera = T_world_camera * motion * SE3{so3_exp(Vector3d(0, 0, turn_rad)), Vector3d::Zero()};
  }
  return trajectory;
}

TrajectoryRequest requested(Protocol protocol, TrajectoryMetric metric) {
  return request_for(protocol, metric).value();
}

TEST(TrajectoryEvaluation, KittiReportsDriftAsShareAndAngleOfTheLength) {
  const Trajectory truth = curve(2000, 0.5);
  const auto scaled =
      evaluate(truth, drifting(truth, 0.02, 0), requested(Protocol::kitti, TrajectoryMetric::rpe));
  ASSERT_TRUE(scaled.has_value()) << scaled.error().message;
  EXPECT_EQ(scaled->series[0].unit, "%");
  // A segment that curves ends at its chord, not its length: the share is below 2 % by that.
  EXPECT_LT(scaled->series[0].stats.mean, 2.0);
  EXPECT_NEAR(scaled->segments[0].translation_percent.mean, 2.0 * std::sin(1.0) * 1.0, 0.02)
      << "100 m at 0.02 rad/m are a chord of 2 R sin(1), with R = 50 m";
  EXPECT_NEAR(scaled->series[1].stats.max, 0.0, 1e-6);

  const auto turned =
      evaluate(truth, drifting(truth, 0, 1e-4), requested(Protocol::kitti, TrajectoryMetric::rpe));
  ASSERT_TRUE(turned.has_value());
  for (const SegmentRow& row : turned->segments)
    EXPECT_NEAR(row.rotation_deg_per_m.mean, degrees(1e-4 / 0.5), 0.02 * degrees(2e-4)) << row.length_m;
  EXPECT_EQ(turned->segments.size(), 8U);
}

TEST(TrajectoryEvaluation, KittiStartsAtEveryTenthPoseAndEndsBeyondTheLength) {
  const Trajectory truth = curve(500, 0.3);
  const IndexPairs segments = kitti_segments(truth, 100);
  ASSERT_FALSE(segments.empty());
  const std::vector<double> path = path_lengths(truth);
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const auto& [i, j] = segments[k];
    EXPECT_EQ(i, 10 * k);
    EXPECT_GT(path[j], path[i] + 100);
    EXPECT_LE(path[j - 1], path[i] + 100);
  }
}

TEST(TrajectoryEvaluation, Eth3dHoldsTheEstimateWhereItIsLost) {
  const Trajectory truth = curve(200, 0.02);
  const TrajectoryRequest request = requested(Protocol::eth3d, TrajectoryMetric::ate);
  const auto whole = evaluate(truth, truth, request);
  ASSERT_TRUE(whole.has_value()) << whole.error().message;
  EXPECT_NEAR(whole->series[0].stats.max, 0, 1e-9);
  const auto lost = evaluate(truth, Trajectory(truth.begin(), truth.begin() + 100), request);
  ASSERT_TRUE(lost.has_value()) << lost.error().message;
  EXPECT_EQ(lost->pairs, 200U) << "giving up is no way to a smaller error";
  EXPECT_GT(lost->series[0].stats.rmse, 0.3);
}

TEST(TrajectoryEvaluation, Eth3dComparesAtTheStampsOfImages) {
  const Trajectory truth = curve(200, 0.02);
  TrajectoryRequest request = requested(Protocol::eth3d, TrajectoryMetric::ate);
  request.association.max_difference_s = 0.15;
  for (std::int64_t k = 0; k < 50; ++k)
    request.association.evaluated_ns.push_back(k * 130'000'000 + 51'000'000);
  request.association.evaluated_ns.push_back(truth.back().timestamp_ns);
  request.association.evaluated_ns.push_back(truth.back().timestamp_ns + 1);
  const auto error = evaluate(truth, drifting(truth, 0.01, 0), request);
  ASSERT_TRUE(error.has_value()) << error.error().message;
  EXPECT_EQ(error->pairs, 50U) << "where ETH3D's program has no reference there is nothing to compare";
  request.association.max_difference_s = 0.05;
  EXPECT_FALSE(evaluate(truth, truth, request).has_value()) << "gaps of the reference are too long";
}

TEST(TrajectoryEvaluation, Eth3dSegmentsAreAboutAsLongAsAsked) {
  const Trajectory truth = curve(400, 0.0173);
  const std::vector<double> path = path_lengths(truth);
  for (const double length_m : {0.5, 1.0, 2.0}) {
    const IndexPairs segments = eth3d_segments(truth, length_m);
    ASSERT_GT(segments.size(), 100U);
    for (const auto& [i, j] : segments) {
      EXPECT_LE(std::abs(path[j] - path[i] - length_m), 0.5 * 0.0173 + 1e-9);
      EXPECT_LT(j + 1, truth.size());
    }
  }
  EXPECT_TRUE(eth3d_segments(curve(100, 0.3), 0.5).empty()) << "no pose within 2.5 cm of 0.5 m";
  const auto drift =
      evaluate(truth, drifting(truth, 0.03, 0), requested(Protocol::eth3d, TrajectoryMetric::rpe));
  ASSERT_TRUE(drift.has_value()) << drift.error().message;
  for (const SegmentRow& row : drift->segments)
    EXPECT_NEAR(row.translation_percent.mean, 3.0, 0.25) << row.length_m;
}

TEST(TrajectoryEvaluation, TumSelectsMotionsBeforeItAsksForTruth) {
  const Trajectory truth = curve(100, 0.02);
  const Trajectory estimate = drifting(truth, 0.1, 0);
  const auto rpe = evaluate(truth, estimate, requested(Protocol::tum, TrajectoryMetric::rpe));
  ASSERT_TRUE(rpe.has_value()) << rpe.error().message;
  ASSERT_EQ(rpe->series.size(), 2U);
  EXPECT_EQ(rpe->series[1].unit, "deg");
  EXPECT_NEAR(rpe->series[0].stats.mean, 0.1 * 10 * 0.02, 1e-3) << "10 frames a second";
  EXPECT_EQ(rpe->possible, 89U) << "motions that end at the last pose do not count";
}

// The numbers of a run's record, which docs/metrics.md reproduces with `eval rpe --protocol tum`.
TEST(TrajectoryEvaluation, TumIsAsInARecordAcrossGaps) {
  const Trajectory truth = curve(600, 0.02);
  Trajectory estimate = drifting(truth, 0.1, 1e-3);
  estimate.erase(estimate.begin() + 400, estimate.begin() + 450);
  estimate.erase(estimate.begin() + 200, estimate.begin() + 215);
  estimate.erase(estimate.begin() + 100);
  TrajectoryRequest request = requested(Protocol::tum, TrajectoryMetric::rpe);
  const auto verb = evaluate(truth, estimate, request);
  const auto record = relative_pose_error(truth, estimate);
  ASSERT_TRUE(verb.has_value() && record.has_value());
  EXPECT_EQ(verb->series[0].errors, record->errors_m);
  EXPECT_EQ(verb->possible, record->possible);
  EXPECT_GT(verb->with_itself, 0U);
  EXPECT_GT(verb->series[0].stats.min, 0);

  // Between two stamps of the reference, further than --t_max_diff from both.
  Trajectory late = truth;
  for (StampedPose& pose : late) pose.timestamp_ns += 40'000'000;
  EXPECT_TRUE(evaluate(truth, late, request).has_value()) << "within twice the median interval";
  request.association.max_difference_s = 0.02;
  EXPECT_FALSE(evaluate(truth, late, request).has_value());
}

TEST(TrajectoryEvaluation, DefaultsAreThoseOfTheProtocol) {
  EXPECT_EQ(requested(Protocol::evo, TrajectoryMetric::ate).alignment.mode, AlignmentMode::none);
  EXPECT_EQ(requested(Protocol::tum, TrajectoryMetric::ate).alignment.mode, AlignmentMode::se3);
  EXPECT_EQ(requested(Protocol::rpg, TrajectoryMetric::ate).alignment.mode, AlignmentMode::sim3);
  EXPECT_FALSE(request_for(Protocol::kitti, TrajectoryMetric::ate).has_value());
  EXPECT_FALSE(parse_protocol("evo2").has_value());
  for (const Protocol protocol :
       {Protocol::evo, Protocol::tum, Protocol::rpg, Protocol::eth3d, Protocol::kitti})
    EXPECT_EQ(parse_protocol(to_string(protocol)).value(), protocol);
}

TEST(TrajectoryEvaluation, SaysWhatIsMissing) {
  const Trajectory truth = curve(100, 0.02);
  const auto short_path = evaluate(truth, truth, requested(Protocol::kitti, TrajectoryMetric::rpe));
  ASSERT_FALSE(short_path.has_value());
  EXPECT_NE(short_path.error().message.find("1.98 m has no segment"), std::string::npos)
      << short_path.error().message;
  TrajectoryRequest strange = requested(Protocol::evo, TrajectoryMetric::rpe);
  strange.delta.value = 1.5;
  EXPECT_EQ(evaluate(truth, truth, strange).error().code, ErrorCode::configuration);
}

TEST(TrajectoryEvaluation, InterpolationFindsTruthBetweenItsStamps) {
  const Trajectory truth = curve(100, 0.02);
  Trajectory estimate;
  for (const StampedPose& pose : truth) {
    const SE3 half = SE3{so3_exp(Vector3d(0, 0, 0.005)), Vector3d(0.01, 0, 0)};
    estimate.push_back({pose.timestamp_ns + 50'000'000, pose.T_world_camera * half});
  }
  TrajectoryRequest request = requested(Protocol::evo, TrajectoryMetric::ate);
  request.association.max_difference_s = 0.06;
  const double nearest_m = evaluate(truth, estimate, request)->series[0].stats.rmse;
  request.association.rule = AssociationRule::interpolated;
  request.association.max_difference_s = 0.11;
  const auto interpolated = evaluate(truth, estimate, request);
  ASSERT_TRUE(interpolated.has_value());
  EXPECT_EQ(interpolated->pairs, 99U);
  EXPECT_GT(nearest_m, 0.009);
  EXPECT_LT(interpolated->series[0].stats.rmse, 1e-4);
}

}  // namespace
}  // namespace fusebench
