#include "core/baselines/elasticfusion/surfels/surfel_cloud.hpp"

#include <gtest/gtest.h>

namespace fusebench {

using namespace baselines::elasticfusion::surfels;

namespace {

TEST(SurfelCloud, HasTheStableSurfelsAsTheyAre) {
  SurfelMap map;
  const Eigen::Vector3f normal = Eigen::Vector3f(0.2F, -0.3F, -1).normalized();
  map.add({{1, 2, 4}, normal, {1, 2, 3}, 0.03F, 9, 0, 0});
  map.add({{1, 2, 3}, normal, {10, 20, 30}, 0.02F, 11, 0, 0});
  const Mesh cloud = surfel_cloud(map, 10);
  ASSERT_EQ(cloud.vertices.size(), 1U);
  EXPECT_TRUE(cloud.triangles.empty());
  EXPECT_EQ(cloud.vertices[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(cloud.normals[0], normal);
  EXPECT_EQ(cloud.colors[0], (Rgb{10, 20, 30}));
  EXPECT_EQ(cloud.radii_m[0], 0.02F);
}

}  // namespace
}  // namespace fusebench
