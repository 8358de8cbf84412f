#include "eval/metrics/mesh_error/mesh_clustering.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_meshes.hpp"

namespace fusebench {

using namespace mesh_error;

namespace {

TEST(MeshClustering, KeepsTheShapeWithFewerTriangles) {
  PreciseMesh ball = testing::sphere(1, 60);
  ball.colors.assign(ball.vertices.size(), Rgb{10, 20, 30});
  ball.quality.assign(ball.vertices.size(), 0.25F);
  const PreciseMesh fewer = reduced(ball, 2000);
  EXPECT_LE(fewer.triangles.size(), 2000U);
  EXPECT_GT(fewer.triangles.size(), 500U);
  ASSERT_EQ(fewer.colors.size(), fewer.vertices.size());
  for (std::size_t i = 0; i < fewer.vertices.size(); ++i) {
    EXPECT_NEAR(fewer.vertices[i].norm(), 1, 0.02);
    EXPECT_EQ(fewer.colors[i], (Rgb{10, 20, 30}));
    EXPECT_FLOAT_EQ(fewer.quality[i], 0.25F);
  }
  for (const auto& triangle : fewer.triangles) {
    for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, fewer.vertices.size());
    EXPECT_TRUE(triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]);
  }
}

TEST(MeshClustering, LeavesASmallMeshAlone) {
  const PreciseMesh ball = testing::sphere(1, 6);
  EXPECT_EQ(reduced(ball, 1000).vertices, ball.vertices);
}

TEST(MeshClustering, SurfelsStillCoverWhatTheyCovered) {
  PreciseMesh wall;
  for (int i = 0; i < 10'000; ++i) {
    wall.vertices.emplace_back(0.01 * (i % 100), 0.01 * (i / 100), 2);
    wall.normals.emplace_back(0, 0, -1);
    wall.radii_m.push_back(0.007F);
  }
  const PreciseMesh fewer = reduced(wall, 500);
  ASSERT_LE(fewer.vertices.size(), 500U);
  ASSERT_GT(fewer.vertices.size(), 100U);
  for (const Vector3d& point : wall.vertices) {
    bool covered = false;
    for (std::size_t i = 0; i < fewer.vertices.size() && !covered; ++i)
      covered = (fewer.vertices[i] - point).norm() <= static_cast<double>(fewer.radii_m[i]) + 1e-9;
    ASSERT_TRUE(covered) << point.transpose();
  }
  for (const Eigen::Vector3f& normal : fewer.normals) EXPECT_EQ(normal, Eigen::Vector3f(0, 0, -1));
}

TEST(MeshClustering, TakesTheSmallestCellThatLeavesFewEnough) {
  const PreciseMesh ball = testing::sphere(1, 40);
  for (const std::size_t most : {2000U, 500U, 90U}) {
    const PreciseMesh fewer = reduced(ball, most);
    double cell_m = 0.005;
    PreciseMesh expected = clustered(ball, cell_m);
    for (; expected.triangles.size() > most; expected = clustered(ball, cell_m)) cell_m *= std::sqrt(2.0);
    EXPECT_EQ(fewer.vertices, expected.vertices) << most;
    EXPECT_EQ(fewer.triangles, expected.triangles) << most;
  }
}

TEST(MeshClustering, AveragesWhatIsInACell) {
  PreciseMesh mesh;
  mesh.vertices = {{0.1, 0.1, 0.1}, {0.3, 0.1, 0.1}, {1.5, 0, 0}, {0, 1.5, 0}};
  mesh.colors = {{0, 0, 0}, {100, 50, 10}, {1, 1, 1}, {2, 2, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 2, 3}};
  const PreciseMesh merged = clustered(mesh, 1);
  ASSERT_EQ(merged.vertices.size(), 3U);
  EXPECT_LT((merged.vertices[0] - Vector3d(0.2, 0.1, 0.1)).norm(), 1e-12);
  EXPECT_EQ(merged.colors[0], (Rgb{50, 25, 5}));
  // The first folds up, the last is the second again.
  EXPECT_EQ(merged.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
}

}  // namespace
}  // namespace fusebench
