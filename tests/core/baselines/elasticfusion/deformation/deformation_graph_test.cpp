#include "core/baselines/elasticfusion/deformation/deformation_graph.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/baselines/elasticfusion/deformation/map_deformation.hpp"

namespace fusebench {

using namespace baselines::elasticfusion;
using namespace baselines::elasticfusion::deformation;

namespace {

/// A corridor along x that is walked through in a hundred frames.
std::vector<TimedPoint> corridor() {
  std::vector<TimedPoint> nodes;
  for (int i = 0; i < 50; ++i) nodes.push_back({{0.1 * i, i % 2 == 0 ? 0.3 : -0.3, 0.2 * (i % 3)}, 2 * i});
  return nodes;
}

PointConstraint held(const Vector3d& position, const Vector3d& target, std::int32_t time) {
  return {{position, time}, {target, time}, false};
}

TEST(DeformationGraph, NeedsFiveNodes) {
  const std::vector<TimedPoint> nodes = corridor();
  EXPECT_FALSE(DeformationGraph::make(std::span(nodes).first(4)).has_value());
  EXPECT_TRUE(DeformationGraph::make(std::span(nodes).first(5)).has_value());
}

TEST(DeformationGraph, SharesAddUpAndFallWithDistance) {
  const auto graph = DeformationGraph::make(corridor());
  const auto influence = graph->influence_of({{2.51, 0.1, 0.1}, 50});
  double sum = 0, before = 1;
  for (const double share : influence.share) {
    EXPECT_GE(share, 0);
    EXPECT_LE(share, before);
    before = share;
    sum += share;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  // The same position at another time belongs to other nodes.
  for (const std::size_t node : graph->influence_of({{2.51, 0.1, 0.1}, 0}).node) EXPECT_LT(node, 20U);
}

TEST(DeformationGraph, KeepsFixedNodes) {
  auto graph = DeformationGraph::make(corridor());
  std::vector<PointConstraint> constraints;
  for (int i = 0; i < 10; ++i) constraints.push_back(held({0.5 * i, 0.1, 0.2}, {0.5 * i, 0.1, 0.2}, 10 * i));
  const auto result = graph->optimise(constraints);
  ASSERT_TRUE(result.has_value());
  EXPECT_NEAR(result->error_before_m, 0, 1e-12);
  EXPECT_NEAR(result->energy, 0, 1e-12);
  const SE3 pose{so3_exp({0.1, 0.2, 0.3}), {2, 0, 0}};
  EXPECT_LT((graph->moved(pose, 40).translation - pose.translation).norm(), 1e-9);
  EXPECT_LT(rotation_angle_rad(graph->moved(pose, 40).rotation, pose.rotation), 1e-6);
}

TEST(DeformationGraph, MovesAsOneIfAllConstraintsMoveAsOne) {
  auto graph = DeformationGraph::make(corridor());
  const SE3 motion{so3_exp({0, 0.05, 0.02}), {0.1, -0.05, 0.02}};
  std::vector<PointConstraint> constraints;
  for (int i = 0; i < 50; i += 3) {
    const Vector3d point(0.1 * i, 0.2, 0.1 * (i % 4));
    constraints.push_back(held(point, motion * point, 2 * i));
  }
  const auto result = graph->optimise(constraints);
  ASSERT_TRUE(result.has_value());
  EXPECT_GT(result->error_before_m, 0.06);
  EXPECT_LT(result->error_after_m, 3e-3);
  const SE3 pose{so3_exp({0.1, 0.2, 0.3}), {2.5, 0.1, 0.1}};
  const SE3 moved = graph->moved(pose, 50);
  EXPECT_LT((moved.translation - (motion * pose).translation).norm(), 0.01);
  EXPECT_LT(rotation_angle_rad(moved.rotation, (motion * pose).rotation), 0.02);
}

TEST(DeformationGraph, BendsTheEndAndLeavesThePinnedBeginning) {
  auto graph = DeformationGraph::make(corridor());
  const Vector3d drift(0, 0.1, 0);
  std::vector<PointConstraint> constraints;
  for (int i = 0; i < 8; ++i) {
    const Vector3d begin(0.05 * i, 0.05 * i, 0.1), end(4.9 - 0.05 * i, 0.05 * i, 0.1);
    constraints.push_back(held(begin, begin, 2));
    constraints.push_back(held(end, end + drift, 97));
  }
  const auto result = graph->optimise(constraints);
  ASSERT_TRUE(result.has_value());
  EXPECT_NEAR(result->error_before_m, 0.05, 1e-9);
  EXPECT_LT(result->error_after_m, 0.003);
  const auto shift_at = [&](double x, std::int32_t time) {
    return (graph->moved(TimedPoint{{x, 0, 0.1}, time}).position - Vector3d(x, 0, 0.1)).y();
  };
  EXPECT_NEAR(shift_at(0.1, 2), 0, 0.01);
  EXPECT_NEAR(shift_at(4.8, 96), 0.1, 0.015);
  EXPECT_NEAR(shift_at(2.5, 50), 0.05, 0.03);
}

TEST(DeformationGraph, NodesOfFixedFramesStay) {
  auto graph = DeformationGraph::make(corridor());
  const Vector3d drift(0, 0.1, 0), early(0.3, 0, 0.1), late(4.8, 0, 0.1);
  const std::vector<PointConstraint> constraints = {held(early, early + drift, 6),
                                                    held(late, late + drift, 96)};
  ASSERT_TRUE(graph->optimise(constraints, 50).has_value());
  EXPECT_NEAR((graph->moved(TimedPoint{early, 6}).position - early).norm(), 0, 1e-12);
  EXPECT_LT((graph->moved(TimedPoint{late, 96}).position - late - drift).norm(), 0.01);

  auto all_fixed = DeformationGraph::make(corridor());
  const auto result = all_fixed->optimise(constraints, 98);
  ASSERT_TRUE(result.has_value());
  EXPECT_NEAR(result->error_after_m, drift.norm(), 1e-12);
}

TEST(DeformationGraph, PointsThatBothMoveMeet) {
  auto graph = DeformationGraph::make(corridor());
  const TimedPoint begin{{0.1, 0, 0.1}, 2}, end{{4.8, 0, 0.1}, 96};
  const Vector3d there(0.1, 0.1, 0.1);
  const std::vector<PointConstraint> constraints = {held(begin.position, there, 2),
                                                    {end, {begin.position + Vector3d(4.7, 0.2, 0), 2}, true}};
  const auto result = graph->optimise(constraints);
  ASSERT_TRUE(result.has_value());
  EXPECT_LT(result->error_after_m, 0.01);
}

TEST(MapDeformation, MovesSurfelsWithTheirNormals) {
  surfels::SurfelMap map;
  for (int i = 0; i < 4000; ++i) {
    surfels::Surfel surfel;
    surfel.position = Eigen::Vector3f(0.001F * static_cast<float>(i), static_cast<float>(i % 7) * 0.1F,
                                      static_cast<float>(i % 5) * 0.1F);
    surfel.normal = Eigen::Vector3f(0, 0, -1);
    surfel.created = i / 40;
    map.add(surfel);
  }
  const PinholeCamera camera = {64, 48, 50, 50, 32, 24};
  EXPECT_FALSE(graph_of(map, camera, 500000).has_value());
  auto graph = graph_of(map, camera, 5000);
  ASSERT_TRUE(graph.has_value());
  EXPECT_EQ(graph->size(), 80U);
  const SE3 motion{so3_exp({0.05, 0, 0}), {0, 0.1, 0}};
  std::vector<PointConstraint> constraints;
  for (std::size_t i = 0; i < map.size(); i += 100) {
    const Vector3d point = map.position[i].cast<double>();
    constraints.push_back(held(point, motion * point, map.created[i]));
  }
  ASSERT_TRUE(graph->optimise(constraints).has_value());
  const surfels::SurfelMap before = map;
  deform(*graph, Workers(2), map);
  for (std::size_t i = 0; i < map.size(); i += 37) {
    EXPECT_LT((map.position[i].cast<double>() - motion * before.position[i].cast<double>()).norm(), 0.01);
    EXPECT_GT(map.normal[i].cast<double>().dot(motion.rotation * Vector3d(0, 0, -1)), 0.999);
  }
}

}  // namespace
}  // namespace fusebench
