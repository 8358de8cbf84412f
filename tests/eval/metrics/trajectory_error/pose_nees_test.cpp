// Covariances that come with a trajectory: honest ones, boastful ones, and files of them.
#include "eval/metrics/trajectory_error/pose_nees.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "core/base/geometry.hpp"
#include "eval/metrics/nees_metrics.hpp"

namespace fusebench {

using namespace trajectory;
using namespace metrics;
using namespace trajectory_files;
using namespace trajectory_error;

namespace {

constexpr std::size_t kPoses = 4000;

struct Case {
  Trajectory truth;
  LoadedTrajectory estimate;
};

Vector3d drawn(const Matrix3d& covariance, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Vector3d unit(normal(random), normal(random), normal(random));
  return Eigen::LLT<Matrix3d>(covariance).matrixL() * unit;
}

/// Estimates whose errors have the covariances that they claim, but for a factor.
Case case_of(double claimed_over_true) {
  std::mt19937_64 random(7);
  Matrix3d orientation;
  orientation << 4e-6, 1e-6, 0, 1e-6, 1e-6, 2e-7, 0, 2e-7, 9e-6;
  Matrix3d position;
  position << 1e-4, 2e-5, 1e-5, 2e-5, 4e-4, 0, 1e-5, 0, 9e-5;
  Case result;
  result.estimate.format = TrajectoryFormat::openvins;
  for (std::size_t i = 0; i < kPoses; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    const SE3 truth{so3_exp(Vector3d(std::sin(t), 0.4 * t, std::cos(0.3 * t))),
                    Vector3d(std::cos(t), std::sin(0.7 * t), 0.2 * t)};
    // The error is truth (-) estimate.
    const Vector3d rotation_error = drawn(orientation, random);
    const SE3 estimate{truth.rotation * so3_exp(-rotation_error),
                       truth.translation - drawn(position, random)};
    const auto stamp_ns = static_cast<std::int64_t>(i) * 10'000'000;
    result.truth.push_back({stamp_ns, truth});
    result.estimate.poses.push_back({stamp_ns, estimate});
    result.estimate.covariances.push_back({claimed_over_true * orientation, claimed_over_true * position});
  }
  return result;
}

PoseConsistency judged(const Case& c, AlignmentMode mode) {
  auto result = pose_consistency(c.truth, c.estimate, {}, {mode});
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
}

TEST(PoseConsistency, AnHonestCovarianceHasUnitNeesAndThreeSigma) {
  const PoseConsistency result = judged(case_of(1), AlignmentMode::none);
  const NeesBounds bounds = nees_bounds_95(kPoses, 3);
  ASSERT_EQ(result.rows.size(), kPoses);
  for (const PartConsistency& part : {result.orientation, result.position}) {
    EXPECT_GT(part.nees.mean, bounds.lower);
    EXPECT_LT(part.nees.mean, bounds.upper);
    EXPECT_NEAR(part.error_rmse / part.sigma_rms, 1, 0.03);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(part.share_within_3_sigma[axis], 0.9973, 0.003);
  }
}

TEST(PoseConsistency, NeesGrowsAsTheClaimShrinks) {
  const PoseConsistency honest = judged(case_of(1), AlignmentMode::none);
  const PoseConsistency boastful = judged(case_of(0.25), AlignmentMode::none);
  EXPECT_NEAR(boastful.position.nees.mean, 4 * honest.position.nees.mean, 1e-9);
  EXPECT_NEAR(boastful.orientation.nees.mean, 4 * honest.orientation.nees.mean, 1e-9);
  EXPECT_LT(boastful.position.share_within_3_sigma.maxCoeff(), 0.9);
}

TEST(PoseConsistency, ItsNumbersDoNotDependOnTheWorldOfTheTruth) {
  Case c = case_of(1);
  const PoseConsistency before = judged(c, AlignmentMode::se3);
  const SE3 T_elsewhere{so3_exp(Vector3d(0.3, -2, 0.7)), Vector3d(5, -3, 2)};
  for (StampedPose& pose : c.truth) pose.T_world_camera = T_elsewhere * pose.T_world_camera;
  const PoseConsistency after = judged(c, AlignmentMode::se3);
  EXPECT_NEAR(after.position.nees.mean, before.position.nees.mean, 1e-6);
  EXPECT_NEAR(after.orientation.nees.mean, before.orientation.nees.mean, 1e-6);
}

TEST(PoseConsistency, CountsWhatHasNoNees) {
  Case c = case_of(1);
  c.estimate.covariances[0] = {};
  const PoseConsistency result = judged(c, AlignmentMode::none);
  EXPECT_EQ(result.singular, 1U);
  EXPECT_EQ(result.rows.size(), kPoses - 1);
}

TEST(PoseConsistency, RefusesWhatHasNoMeaning) {
  Case c = case_of(1);
  EXPECT_FALSE(pose_consistency(c.truth, c.estimate, {}, {AlignmentMode::sim3}));
  for (PoseCovariance& covariance : c.estimate.covariances) covariance = {};
  const auto singular = pose_consistency(c.truth, c.estimate, {}, {AlignmentMode::none});
  ASSERT_FALSE(singular);
  EXPECT_NE(singular.error().message.find("all 4000"), std::string::npos);
  c.estimate.covariances.clear();
  EXPECT_FALSE(pose_consistency(c.truth, c.estimate, {}, {AlignmentMode::none}));
}

TEST(PoseConsistency, ReadsTheFormatOfOvEval) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "openvins.txt";
  const std::string pose = "2.5 1 2 3 0 0 0 1 ";
  std::ofstream(file) << "# timestamp(s) ...\n1.5 0 0 0 0 0 0 1 11 12 13 22 23 33 1.1 1.2 1.3 2.2 2.3 3.3\n"
                      << pose << "1 0 0 1 0 1 1 0 0 1 0 1\n";
  std::vector<std::string> warnings;
  const auto loaded = load_trajectory(file, {}, warnings);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->format, TrajectoryFormat::openvins);
  ASSERT_EQ(loaded->covariances.size(), 2U);
  Matrix3d expected;
  expected << 11, 12, 13, 12, 22, 23, 13, 23, 33;
  EXPECT_TRUE(loaded->covariances[0].orientation_rad2.isApprox(expected, 0));
  EXPECT_TRUE(loaded->covariances[0].position_m2.isApprox(0.1 * expected, 1e-15));
  std::ofstream(file) << pose << "1 0 0 -1 0 1 1 0 0 1 0 1\n";
  const auto negative = load_trajectory(file, {}, warnings);
  ASSERT_FALSE(negative);
  EXPECT_NE(negative.error().message.find(":1: a variance is below zero"), std::string::npos);
}

}  // namespace
}  // namespace fusebench
