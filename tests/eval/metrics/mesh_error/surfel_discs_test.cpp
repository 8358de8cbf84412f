#include "eval/metrics/mesh_error/surfel_discs.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/support/test_meshes.hpp"

namespace fusebench {

using namespace mesh_error;

namespace {

TEST(SurfelDiscs, AreTrianglesOfTheSameArea) {
  PreciseMesh surfels;
  const Vector3d normal = Vector3d(0.2, -0.3, -1).normalized();
  surfels.vertices = {{1, 2, 3}};
  surfels.normals = {normal.cast<float>()};
  surfels.colors = {{10, 20, 30}};
  surfels.radii_m = {0.02F};
  const PreciseMesh discs = with_discs(surfels);
  ASSERT_EQ(discs.triangles.size(), 1U);
  ASSERT_EQ(discs.vertices.size(), 3U);
  const Vector3d &a = discs.vertices[0], &b = discs.vertices[1], &c = discs.vertices[2];
  EXPECT_LT(((a + b + c) / 3 - surfels.vertices[0]).norm(), 1e-9);
  const Vector3d twice_area = (b - a).cross(c - a);
  EXPECT_NEAR(twice_area.norm() / 2, std::numbers::pi * 0.02 * 0.02, 1e-9);
  EXPECT_GT(twice_area.normalized().dot(normal), 0.999999) << "counter-clockwise from outside";
  EXPECT_EQ(discs.normals[2], surfels.normals[0]);
  EXPECT_EQ(discs.colors[1], (Rgb{10, 20, 30}));
  EXPECT_TRUE(discs.radii_m.empty());
}

TEST(SurfelDiscs, LeaveAMeshAsItIs) {
  const PreciseMesh ball = testing::sphere(1, 6);
  const PreciseMesh same = with_discs(ball);
  EXPECT_EQ(same.vertices, ball.vertices);
  EXPECT_EQ(same.triangles, ball.triangles);
}

}  // namespace
}  // namespace fusebench
