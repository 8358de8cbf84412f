#include "core/estimator/places/loops/pose_graph.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "core/base/geometry.hpp"

namespace fusebench {

using namespace loops;

namespace {

constexpr std::size_t kPlaces = 40;

/// Once around a circle of 2 m radius, looking outwards; the last place is where the first one was.
std::vector<SE3> circle() {
  std::vector<SE3> poses;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / (kPlaces - 1);
    poses.push_back({so3_exp({0, angle, 0}), {2 * std::sin(angle), 0, 2 * std::cos(angle)}});
  }
  return poses;
}

Matrix6d covariance(double rotation_rad, double position_m) {
  Vector6d sigmas;
  sigmas << Vector3d::Constant(rotation_rad), Vector3d::Constant(position_m);
  return sigmas.cwiseAbs2().asDiagonal();
}

/// The path as odometry with these errors a step sees it, with its edges.
PoseGraph drifted(const std::vector<SE3>& truth, double rotation_rad, double position_m, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  PoseGraph graph;
  graph.T_world_camera = {truth.front()};
  graph.gravity_camera.assign(truth.size(), std::nullopt);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    Vector6d error;
    for (int k = 0; k < 6; ++k) error[k] = (k < 3 ? rotation_rad : position_m) * normal(generator);
    const SE3 step = pose_plus(truth[i - 1].inverse() * truth[i], error);
    graph.edges.push_back({i - 1, i, step, covariance(rotation_rad, position_m), false});
    graph.T_world_camera.push_back(graph.T_world_camera.back() * step);
  }
  return graph;
}

double rmse_m(const std::vector<SE3>& poses, const std::vector<SE3>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    sum += (poses[i].translation - truth[i].translation).squaredNorm();
  return std::sqrt(sum / static_cast<double>(poses.size()));
}

GraphEdge loop_of(const std::vector<SE3>& truth, std::size_t a, std::size_t b) {
  return {a, b, truth[a].inverse() * truth[b], covariance(0.002, 0.004), true};
}

TEST(PoseGraph, StaysWhereItIsWithoutLoops) {
  const PoseGraph graph = drifted(circle(), 0.005, 0.01, 1);
  const auto poses = optimised_poses(graph);
  ASSERT_TRUE(poses) << poses.error().message;
  EXPECT_LT(rmse_m(*poses, graph.T_world_camera), 1e-6);
}

TEST(PoseGraph, ALoopTakesMostOfTheDriftAway) {
  const std::vector<SE3> truth = circle();
  double before = 0, after = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    PoseGraph graph = drifted(truth, 0.01, 0.02, seed);
    graph.edges.push_back(loop_of(truth, 0, kPlaces - 1));
    const auto poses = optimised_poses(graph);
    ASSERT_TRUE(poses) << poses.error().message;
    before += rmse_m(graph.T_world_camera, truth);
    after += rmse_m(*poses, truth);
    EXPECT_LT((poses->back().translation - truth.back().translation).norm(), 0.02);
    EXPECT_EQ(poses->front().translation, truth.front().translation) << "the first place is the world";
  }
  EXPECT_LT(after, 0.6 * before);
}

TEST(PoseGraph, ResidualsOfTheGroundTruthHaveSixDegreesOfFreedom) {
  const std::vector<SE3> truth = circle();
  double sum = 0;
  std::size_t edges = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const GraphEdge& edge : drifted(truth, 0.01, 0.02, seed).edges) {
      sum += squared_residual(edge, truth);
      ++edges;
    }
  }
  EXPECT_NEAR(sum / static_cast<double>(edges), 6, 0.5);
}

TEST(PoseGraph, AFalseLoopHardlyPulls) {
  const std::vector<SE3> truth = circle();
  PoseGraph graph = drifted(truth, 0.005, 0.01, 3);
  graph.edges.push_back(loop_of(truth, 0, kPlaces - 1));
  const auto without = optimised_poses(graph);
  GraphEdge wrong = loop_of(truth, 5, 25);
  wrong.T_a_b.translation += Vector3d(1, 0, 1);
  graph.edges.push_back(wrong);
  const auto with = optimised_poses(graph);
  ASSERT_TRUE(without && with);
  EXPECT_LT(rmse_m(*with, *without), 0.05);
  EXPECT_GT(squared_residual(wrong, *with), 6 * 9) << "and shows itself by its residual";
}

TEST(PoseGraph, GravityPinsRollAndPitchAndNotYaw) {
  const std::vector<SE3> truth = circle();
  PoseGraph graph = drifted(truth, 0.01, 0.0005, 4);
  graph.gravity_sigma_rad = 0.001;
  for (std::size_t i = 0; i < truth.size(); ++i)
    graph.gravity_camera[i] = truth[i].rotation.conjugate() * Vector3d::UnitY();
  const auto poses = optimised_poses(graph);
  ASSERT_TRUE(poses) << poses.error().message;
  const auto tilt = [&](const SE3& pose, std::size_t i) {
    return (pose.rotation.conjugate() * Vector3d::UnitY() - *graph.gravity_camera[i]).norm();
  };
  double worst_before = 0, worst_after = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    worst_before = std::max(worst_before, tilt(graph.T_world_camera[i], i));
    worst_after = std::max(worst_after, tilt((*poses)[i], i));
  }
  EXPECT_GT(worst_before, 0.02);
  EXPECT_LT(worst_after, 0.005);
}

TEST(PoseGraph, SingularCovariancesAreErrors) {
  PoseGraph graph = drifted(circle(), 0.005, 0.01, 1);
  graph.edges.back().covariance.setZero();
  const auto poses = optimised_poses(graph);
  ASSERT_FALSE(poses);
  EXPECT_EQ(poses.error().code, ErrorCode::run_failed);
}

}  // namespace
}  // namespace fusebench
