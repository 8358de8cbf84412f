#include "eval/metrics/mesh_error/triangle_tree.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/test_meshes.hpp"

namespace fusebench {

using namespace mesh_error;

namespace {

using testing::random_point;
using testing::triangle_soup;

/// Another way to a distance: the foot on the plane by its normal equations, or the best of the edges.
double reference_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const auto to_edge = [&](const Vector3d& from, const Vector3d& to) {
    if (from == to) return (p - from).norm();
    const Eigen::ParametrizedLine<double, 3> line(from, (to - from).normalized());
    const double along = line.direction().dot(p - from);
    if (along <= 0) return (p - from).norm();
    if (along >= (to - from).norm()) return (p - to).norm();
    return (p - line.pointAt(along)).norm();
  };
  double best = std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
  Eigen::Matrix<double, 3, 2> edges;
  edges << b - a, c - a;
  const Eigen::Matrix2d square = edges.transpose() * edges;
  if (square.determinant() > 1e-18) {
    const Vector2d uv = square.inverse() * (edges.transpose() * (p - a));
    if (uv.minCoeff() >= 0 && uv.sum() <= 1) best = std::min(best, (p - a - edges * uv).norm());
  }
  return best;
}

double brute_force(const PreciseMesh& mesh, const Vector3d& point) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : mesh.triangles) {
    best = std::min(best, reference_distance(point, mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]));
  }
  return best;
}

TEST(TriangleTree, EqualsASearchThroughAllTriangles) {
  const PreciseMesh mesh = triangle_soup(600);
  const TriangleTree tree(mesh, Workers(2));
  std::mt19937_64 random(5);
  NearestTriangle hint;
  for (int i = 0; i < 3000; ++i) {
    Vector3d point = random_point(random, i % 2 == 0 ? 1.0 : 5.0);
    if (i % 7 == 0) point = mesh.vertices[static_cast<std::size_t>(i) % mesh.vertices.size()];
    const double distance = std::sqrt(tree.nearest(point).squared_m2);
    EXPECT_NEAR(distance, brute_force(mesh, point), 1e-9) << point.transpose();
    const NearestTriangle found = tree.nearest(point);
    EXPECT_NEAR((point - tree.closest_point(point, found.place)).norm(), distance, 1e-9);
    hint = tree.nearest(point, hint);  // the hint is of another place
    EXPECT_EQ(std::sqrt(hint.squared_m2), distance);
  }
}

TEST(TriangleTree, IsTheSameHoweverManyThreadsBuiltIt) {
  const PreciseMesh mesh = testing::sphere(1, 100);  // more triangles than one thread takes
  const TriangleTree one(mesh, Workers(1));
  const TriangleTree three(mesh, Workers(3));
  std::mt19937_64 random(6);
  for (int i = 0; i < 500; ++i) {
    const Vector3d point = random_point(random, 1.5);
    EXPECT_EQ(one.nearest(point).place, three.nearest(point).place);
    EXPECT_EQ(one.nearest(point).squared_m2, three.nearest(point).squared_m2);
  }
}

TEST(TriangleTree, RegionsOfOneTriangle) {
  const std::array<Vector3d, 3> t = {Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(0, 1, 0)};
  EXPECT_DOUBLE_EQ(squared_distance_to_triangle({0.5, 0.25, -3}, t), 9);  // inside, from below
  EXPECT_DOUBLE_EQ(squared_distance_to_triangle({1, -2, 0}, t), 4);       // an edge
  EXPECT_DOUBLE_EQ(squared_distance_to_triangle({5, 0, 4}, t), 25);       // a corner
  EXPECT_DOUBLE_EQ(squared_distance_to_triangle({2, 1, 0}, t), 0.8);      // the long edge
  EXPECT_EQ(squared_distance_to_triangle({0.5, 0.25, 0}, t), 0);
}

TEST(TriangleTree, KnowsWhatIsInTheWay) {
  const PreciseMesh mesh = triangle_soup(400);
  const TriangleTree tree(mesh, Workers(2));
  std::mt19937_64 random(9);
  int crossed = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d from = random_point(random, 1.5);
    const Vector3d to = random_point(random, 1.5);
    bool expected = false;
    for (const auto& [a, b, c] : mesh.triangles) {
      Matrix3d system;  // from + x (to - from) = a + y (b - a) + z (c - a)
      const Vector3d corner = mesh.vertices[a];
      system << from - to, mesh.vertices[b] - corner, mesh.vertices[c] - corner;
      const Vector3d x = system.fullPivLu().solve(from - corner);
      if ((system * x - (from - corner)).norm() > 1e-9) continue;
      expected = expected || (x.minCoeff() >= 0 && x[0] <= 1 && x[1] + x[2] <= 1);
    }
    EXPECT_EQ(tree.blocked(from, to), expected);
    crossed += expected ? 1 : 0;
  }
  EXPECT_GT(crossed, 200);
  EXPECT_LT(crossed, 1800);
}

TEST(TriangleTree, LinesAlongAnAxisAndThroughAPlane) {
  PreciseMesh wall;
  wall.vertices = {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  const TriangleTree tree(wall, Workers(2));
  EXPECT_TRUE(tree.blocked({0, 0.1, 0.2}, {2, 0.1, 0.2}));
  EXPECT_TRUE(tree.blocked({2, 0.1, 0.2}, {0, 0.1, 0.2}));
  EXPECT_FALSE(tree.blocked({0, 0.1, 0.2}, {0.99, 0.1, 0.2}));
  EXPECT_FALSE(tree.blocked({0, 0.1, 1.2}, {2, 0.1, 1.2}));
  EXPECT_FALSE(tree.blocked({0, 0, 0}, {0, 5, 0}));
}

}  // namespace
}  // namespace fusebench
