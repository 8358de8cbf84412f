#include "core/base/mesh/mesh_file.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fusebench::mesh {
namespace {

TEST(ScaledMesh, VerticesAndRadiiAreInTheUnitAndNormalsAreNot) {
  PreciseMesh surfels;
  surfels.vertices = {{1000, 0, -500}, {2000, 4, 0}};
  surfels.normals = {{0, 0, 1}, {0, 1, 0}};
  surfels.radii_m = {8, 16};
  const PreciseMesh in_metres = scaled(surfels, 0.5);
  EXPECT_EQ(in_metres.vertices, (std::vector<Vector3d>{{500, 0, -250}, {1000, 2, 0}}));
  EXPECT_EQ(in_metres.normals, surfels.normals);
  EXPECT_EQ(in_metres.radii_m, (std::vector<float>{4, 8}));
}

}  // namespace
}  // namespace fusebench::mesh
