#include "eval/mesh_error/mesh_sampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace fusebench {

using namespace mesh_error;

namespace {

TEST(MeshSampling, SpreadsEvenlyOverTheArea) {
  PreciseMesh
      mesh;  // a unit square, three quarters of it in one large triangle and a quarter in many small ones
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto points = sample_mesh(mesh, {MeshSamples::area, 40'000, 7});
  ASSERT_TRUE(points.has_value());
  ASSERT_EQ(points->size(), 40'000U);
  std::array<int, 16> cells{};
  for (const Vector3d& point : *points) {
    EXPECT_EQ(point.z(), 0);
    ASSERT_TRUE(point.minCoeff() >= 0 && point.maxCoeff() <= 1);
    ++cells[static_cast<std::size_t>(4 * std::min(3, static_cast<int>(4 * point.x())) +
                                     std::min(3, static_cast<int>(4 * point.y())))];
  }
  for (const int count : cells) EXPECT_NEAR(count, 2500, 5 * 50);  // five sigma of a Poisson count
  EXPECT_EQ((*sample_mesh(mesh, {MeshSamples::area, 100, 7}))[99],
            (*sample_mesh(mesh, {MeshSamples::area, 100, 7}))[99]);
  EXPECT_NE((*sample_mesh(mesh, {MeshSamples::area, 100, 8}))[0],
            (*sample_mesh(mesh, {MeshSamples::area, 100, 7}))[0]);
  EXPECT_EQ(sample_mesh(mesh, {MeshSamples::vertices, 0, 0})->size(), 5U);
  mesh.triangles = {{0, 0, 1}};
  EXPECT_FALSE(sample_mesh(mesh, {}).has_value());
}

}  // namespace
}  // namespace fusebench
