#include "eval/metrics/mesh_error/mesh_sampling.hpp"

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
  EXPECT_EQ(sample_mesh(mesh, {MeshSamples::vertices, 0, 0})->size(), 5U) << "one belongs to no triangle";
  mesh.triangles = {{0, 0, 1}};
  EXPECT_FALSE(sample_mesh(mesh, {}).has_value());
}

TEST(MeshSampling, TakesTheCentresOfSurfelsAsTheirVertices) {
  PreciseMesh surfels;
  surfels.vertices = {{1, 2, 3}, {4, 5, 6}};
  surfels.normals = {{0, 0, 1}, {0, 0, 1}};
  surfels.radii_m = {0.02F, 0.03F};
  ASSERT_TRUE(check_mesh(surfels, "the reconstruction").has_value());
  EXPECT_EQ(sample_mesh(surfels, {MeshSamples::vertices, 0, 0}).value(), surfels.vertices);
  const auto spread = sample_mesh(surfels, {MeshSamples::area, 1000, 1});
  ASSERT_TRUE(spread.has_value()) << spread.error().message;
  const auto of_first = std::ranges::count_if(*spread, [](const Vector3d& point) { return point.z() < 4; });
  EXPECT_NEAR(static_cast<double>(of_first), 1000.0 * 4 / 13, 2) << "in proportion to their areas";
  surfels.normals[1].setZero();
  const auto refused = check_mesh(surfels, "the reconstruction");
  ASSERT_FALSE(refused.has_value());
  EXPECT_TRUE(refused.error().message.starts_with("the reconstruction: surfel 1 has normal 0 0 0"))
      << refused.error().message;
}

TEST(MeshSampling, RefusesPointsWithoutASurface) {
  PreciseMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {7, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_TRUE(check_mesh(mesh, "the truth").has_value());
  EXPECT_EQ(surface_vertices(mesh).size(), 3U);
  mesh.triangles = {};
  EXPECT_FALSE(check_mesh(mesh, "the truth").has_value()) << "points without a radius are no surface";
}

}  // namespace
}  // namespace fusebench
