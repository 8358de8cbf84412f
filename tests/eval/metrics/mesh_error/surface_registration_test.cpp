#include "eval/metrics/mesh_error/surface_registration.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/base/geometry.hpp"
#include "eval/metrics/mesh_error/mesh_sampling.hpp"
#include "tests/support/test_meshes.hpp"

namespace fusebench {

using namespace mesh_error;

namespace {

/// Floor and two walls of a room of 4 x 3 x 2.5 m.
PreciseMesh corner() {
  PreciseMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}, {0, 0, 2.5}, {4, 0, 2.5}, {0, 3, 2.5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 5}, {0, 5, 4}, {0, 3, 6}, {0, 6, 4}};
  return mesh;
}

std::vector<Vector3d> moved(std::vector<Vector3d> points, const SE3& transform) {
  for (Vector3d& point : points) point = transform * point;
  return points;
}

const SE3 kMoved{so3_exp({0.03, -0.05, 0.08}), {0.06, -0.04, 0.05}};

TEST(SurfaceRegistration, FindsTheTransformThatThePointsWereMovedBy) {
  const PreciseMesh mesh = corner();
  const Workers workers(2);
  const TriangleTree surface(mesh, workers);
  const auto points = sample_mesh(mesh, {MeshSamples::area, 3000, 1}).value();
  const auto result = register_points(moved(points, kMoved.inverse()), surface, SE3{}, {.kept = 1}, workers);
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_TRUE(result->converged);
  EXPECT_EQ(result->free_directions, 0);
  EXPECT_LT(rotation_angle_rad(result->T_surface_points.rotation, kMoved.rotation), 1e-6);
  EXPECT_LT((result->T_surface_points.translation - kMoved.translation).norm(), 1e-6);
}

TEST(SurfaceRegistration, WhatIsNotInTheTruthDoesNotPull) {
  const PreciseMesh mesh = corner();
  const Workers workers(1);
  const TriangleTree surface(mesh, workers);
  auto points = sample_mesh(mesh, {MeshSamples::area, 2000, 1}).value();
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i)  // a tenth: a thing that stands in the room
    points.emplace_back(Vector3d(2, 1.5, 1.2) + testing::random_point(random, 0.2));
  const auto error_with = [&](double kept) {
    const auto result =
        register_points(moved(points, kMoved.inverse()), surface, SE3{}, {.kept = kept}, workers);
    return (result->T_surface_points.translation - kMoved.translation).norm();
  };
  EXPECT_LT(error_with(0.85), 1e-6);
  EXPECT_GT(error_with(1), 0.02);
}

TEST(SurfaceRegistration, APlaneLeavesThreeDirectionsAlone) {
  PreciseMesh plane;
  plane.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
  plane.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Workers workers(1);
  const TriangleTree surface(plane, workers);
  std::vector<Vector3d> points;
  std::mt19937_64 random(4);
  for (int i = 0; i < 500; ++i) {
    const Vector3d point = testing::random_point(random, 1);
    points.emplace_back(2 + point.x(), 1.5 + point.y(), 0.05);
  }
  const auto result = register_points(points, surface, SE3{}, {.kept = 1}, workers);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->free_directions, 3);
  EXPECT_LT((result->T_surface_points.translation - Vector3d(0, 0, -0.05)).norm(), 1e-9);
}

TEST(SurfaceRegistration, SaysWhatItCannotDo) {
  const PreciseMesh mesh = corner();
  const Workers workers(1);
  const TriangleTree surface(mesh, workers);
  const std::vector<Vector3d> few(5, Vector3d(1, 1, 1));
  EXPECT_EQ(register_points(few, surface, SE3{}, {}, workers).error().code, ErrorCode::data_corrupt);
  const std::vector<Vector3d> one_place(50, Vector3d(1, 1, 1));
  EXPECT_NE(register_points(one_place, surface, SE3{}, {}, workers).error().message.find("in one place"),
            std::string::npos);
  EXPECT_EQ(register_points(one_place, surface, SE3{}, {.kept = 0}, workers).error().code, ErrorCode::usage);
}

TEST(SurfaceRegistration, SameTransformWithAnyThreadCount) {
  const PreciseMesh mesh = corner();
  const auto points = sample_mesh(mesh, {MeshSamples::area, 5000, 3}).value();
  const auto with = [&](int threads) {
    const Workers workers(threads);
    return register_points(moved(points, kMoved.inverse()), TriangleTree(mesh, workers), SE3{}, {}, workers)
        ->T_surface_points;
  };
  EXPECT_EQ(with(1).translation, with(3).translation);
  EXPECT_EQ(with(1).rotation.coeffs(), with(3).rotation.coeffs());
}

}  // namespace
}  // namespace fusebench
