#include "core/systems/elasticfusion/surfels/disc_mesh.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace fusebench {

using namespace systems::elasticfusion::surfels;

namespace {

TEST(DiscMesh, HasATriangleOfTheAreaOfEachStableDisc) {
  SurfelMap map;
  const Eigen::Vector3f normal = Eigen::Vector3f(0.2F, -0.3F, -1).normalized();
  map.add({{1, 2, 3}, normal, {10, 20, 30}, 0.02F, 11, 0, 0});
  map.add({{1, 2, 4}, normal, {10, 20, 30}, 0.02F, 9, 0, 0});
  const Mesh mesh = disc_mesh(map, 10);
  ASSERT_EQ(mesh.triangles.size(), 1U);
  ASSERT_EQ(mesh.vertices.size(), 3U);
  const Eigen::Vector3f &a = mesh.vertices[0], &b = mesh.vertices[1], &c = mesh.vertices[2];
  EXPECT_LT(((a + b + c) / 3 - map.position[0]).norm(), 1e-6F);
  const Eigen::Vector3f twice_area = (b - a).cross(c - a);
  EXPECT_NEAR(static_cast<double>(twice_area.norm()) / 2, std::numbers::pi * 0.02 * 0.02, 1e-7);
  EXPECT_GT(twice_area.normalized().dot(normal), 0.9999F) << "counter-clockwise from outside";
  EXPECT_EQ(mesh.normals[2], normal);
  EXPECT_EQ(mesh.colors[1], (Rgb{10, 20, 30}));
}

}  // namespace
}  // namespace fusebench
