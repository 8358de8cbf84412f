#include "eval/metrics/mesh_error/vertex_tree.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "core/base/geometry.hpp"
#include "tests/support/test_meshes.hpp"

namespace fusebench {

using namespace mesh_error;

namespace {

TEST(VertexTree, EqualsASearchThroughAllPoints) {
  std::mt19937_64 random(1);
  std::vector<Vector3d> points;
  for (int i = 0; i < 2000; ++i) points.push_back(testing::random_point(random, 1));
  const VertexTree tree(points);
  for (int i = 0; i < 500; ++i) {
    const Vector3d wanted = testing::random_point(random, 2);
    double best = std::numeric_limits<double>::infinity();
    for (const Vector3d& point : points) best = std::min(best, (point - wanted).squaredNorm());
    const VertexTree::Nearest found = tree.nearest(wanted);
    EXPECT_DOUBLE_EQ(found.squared_m2, best);
    EXPECT_DOUBLE_EQ((tree[found.index] - wanted).squaredNorm(), best);
  }
}

/// Vertices of a torn surface, a centimetre or more apart.
std::vector<Vector3d> scattered() {
  std::vector<Vector3d> points;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) points.emplace_back(0.1 * i, 0.1 * j, 0.05 * ((i * 7 + j * 3) % 5));
  }
  return points;
}

TEST(SurfregScore, IsTheMeanBeforeAndAfterItsIcp) {
  const Workers workers(2);
  const VertexTree truth(scattered());
  std::vector<Vector3d> shifted = scattered();
  for (Vector3d& point : shifted) point += Vector3d(0.01, -0.02, 0.005);
  const SurfregScore score = surfreg_score(shifted, truth, workers);
  EXPECT_NEAR(score.vertex_mean_m, Vector3d(0.01, -0.02, 0.005).norm(), 1e-12);
  ASSERT_TRUE(score.after_icp_m.has_value());
  EXPECT_LT(*score.after_icp_m, 1e-9);
}

TEST(SurfregScore, TakesNoIcpFromFiveCentimetresOn) {
  const Workers workers(1);
  const VertexTree truth(scattered());
  std::vector<Vector3d> far = scattered();
  for (Vector3d& point : far) point.z() += 3;
  EXPECT_FALSE(surfreg_score(far, truth, workers).after_icp_m.has_value());
  // Nor where its steps have no solution: all in one place.
  const std::vector<Vector3d> one_place(10, scattered().front());
  const SurfregScore score = surfreg_score(one_place, truth, workers);
  EXPECT_EQ(score.vertex_mean_m, 0);
  EXPECT_FALSE(score.after_icp_m.has_value());
}

}  // namespace
}  // namespace fusebench
