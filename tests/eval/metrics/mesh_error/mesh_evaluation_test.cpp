#include "eval/metrics/mesh_error/mesh_evaluation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "core/base/geometry.hpp"
#include "tests/support/test_meshes.hpp"

namespace fusebench {

using namespace mesh_error;

namespace {

using testing::sphere;

/// Not round, so that a registration has one answer.
PreciseMesh egg(double radius_m) {
  PreciseMesh mesh = sphere(radius_m, 30);
  for (Vector3d& vertex : mesh.vertices) vertex = vertex.cwiseProduct(Vector3d(1, 1.3, 0.8));
  return mesh;
}

PreciseMesh moved(PreciseMesh mesh, const SE3& transform) {
  for (Vector3d& vertex : mesh.vertices) vertex = transform * vertex;
  return mesh;
}

TEST(MeshEvaluation, MillimetresAreNotMetres) {
  const Workers workers(1);
  PreciseMesh millimetres = egg(1);
  for (Vector3d& vertex : millimetres.vertices) vertex *= 1000;
  const auto refused = evaluate_mesh(millimetres, egg(1), {}, workers);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(refused.error().hint.find("--scale 0.001"), std::string::npos);
  EXPECT_FALSE(evaluate_mesh(egg(1), millimetres, {}, workers).has_value());
  EXPECT_TRUE(evaluate_mesh(millimetres, egg(1), {.any_size = true}, workers).has_value());
  EXPECT_TRUE(evaluate_mesh(egg(0.06), egg(1), {}, workers).has_value());
}

TEST(MeshEvaluation, IcpBringsTheReconstructionBack) {
  const Workers workers(2);
  const SE3 elsewhere{so3_exp({0.05, 0.02, -0.04}), {0.03, -0.05, 0.02}};
  MeshRequest request;
  request.icp = RegistrationOptions{};
  const auto result = evaluate_mesh(moved(egg(1), elsewhere.inverse()), egg(1), request, workers);
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_EQ(result->errors.alignment.mode, "icp");
  EXPECT_EQ(result->icp_doubt, "");
  EXPECT_LT(result->errors.accuracy.stats.max, 1e-5);
  EXPECT_LT((result->errors.alignment.T_reference_estimate.translation - elsewhere.translation).norm(), 1e-5);
  EXPECT_LT(result->surfreg.vertex_mean_m, 1e-4);
  request.icp.reset();
  const auto there = evaluate_mesh(moved(egg(1), elsewhere.inverse()), egg(1), request, workers);
  EXPECT_GT(there->errors.accuracy.stats.mean, 0.01);
  request.start = {"file", elsewhere};
  EXPECT_LT(
      evaluate_mesh(moved(egg(1), elsewhere.inverse()), egg(1), request, workers)->errors.accuracy.stats.max,
      1e-9);
}

TEST(MeshEvaluation, AnIcpThatSticksInAWrongPlaceIsRefused) {
  const Workers workers(1);
  const SE3 elsewhere{so3_exp({0, 0, 1.5}), {1.0, 0.3, 0}};
  MeshRequest request;
  request.icp = RegistrationOptions{.max_steps = 3};
  const PreciseMesh reconstruction = moved(egg(1), elsewhere.inverse());
  const auto refused = evaluate_mesh(reconstruction, egg(1), request, workers);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(refused.error().hint.find("--trajectories"), std::string::npos) << refused.error().hint;
  request.errors.thresholds_m = {0.05, 10};
  EXPECT_TRUE(evaluate_mesh(reconstruction, egg(1), request, workers).has_value());
  request.errors = {};
  request.start = {"trajectory", elsewhere};
  EXPECT_TRUE(evaluate_mesh(reconstruction, egg(1), request, workers).has_value());
}

TEST(MeshEvaluation, AnIcpWithoutAStartThatMovedFarIsDoubted) {
  const Workers workers(1);
  const SE3 elsewhere{so3_exp({0, 0, 0.5}), {0.02, 0.03, 0}};
  MeshRequest request;
  request.icp = RegistrationOptions{};
  const PreciseMesh reconstruction = moved(egg(1), elsewhere.inverse());
  const auto far = evaluate_mesh(reconstruction, egg(1), request, workers);
  ASSERT_TRUE(far.has_value()) << far.error().message;
  EXPECT_NE(far->icp_doubt.find("turned by 28.6 deg"), std::string::npos) << far->icp_doubt;
  EXPECT_NE(far->icp_doubt.find("--trajectories TRUTH ESTIMATE"), std::string::npos) << far->icp_doubt;
  request.start = {"trajectory", elsewhere};
  EXPECT_EQ(evaluate_mesh(reconstruction, egg(1), request, workers)->icp_doubt, "");
}

TEST(MeshEvaluation, AnIcpWithoutAStartThatEndedFarFromTheTruthIsDoubted) {
  const Workers workers(1);
  MeshRequest request;
  request.icp = RegistrationOptions{};
  const auto loose = evaluate_mesh(sphere(1.03, 30), sphere(1, 30), request, workers);
  ASSERT_TRUE(loose.has_value()) << loose.error().message;
  EXPECT_NE(loose->icp_doubt.find("m (rms) from the ground truth"), std::string::npos) << loose->icp_doubt;
  EXPECT_EQ(evaluate_mesh(sphere(1.01, 30), sphere(1, 30), request, workers)->icp_doubt, "");
}

TEST(MeshEvaluation, TellsBothWithAndWithoutCulling) {
  const Workers workers(1);
  PreciseMesh half = sphere(1, 30);
  std::erase_if(half.triangles, [&](const auto& t) { return half.vertices[t[0]].z() > 0.2; });
  MeshRequest request;
  request.views =
      MeshViews{{640, 480, 400, 400, 319.5, 239.5}, 0.1, 10, {{Quaterniond::Identity(), {0, 0, -3}}}};
  const auto result = evaluate_mesh(half, sphere(1, 30), request, workers);
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_LT(result->errors.completeness.stats.max, 1e-6);  // what the camera saw is there
  ASSERT_TRUE(result->not_culled.has_value());
  EXPECT_GT(result->not_culled->completeness.stats.max, 0.5);
  EXPECT_LT(result->truth_observed, result->truth_samples / 2);
  request.least_observed = 0.5;
  const auto refused = evaluate_mesh(half, sphere(1, 30), request, workers);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("% of the ground-truth surface is observed"), std::string::npos);
}

TEST(MeshEvaluation, DistancesOfVerticesOnRequest) {
  const Workers workers(1);
  const auto result = evaluate_mesh(sphere(1.02, 40), sphere(1, 40), {.vertex_errors = true}, workers);
  ASSERT_TRUE(result.has_value());
  ASSERT_EQ(result->vertex_errors_m.size(), sphere(1.02, 40).vertices.size());
  for (const double error_m : result->vertex_errors_m) EXPECT_NEAR(error_m, 0.02, 1e-4);  // facets are flat
}

/// 0.01 m above the square from (0, 0) to (1, 1), every 0.1 m.
PreciseMesh surfels_above_square() {
  PreciseMesh surfels;
  for (int i = 0; i <= 10; ++i) {
    for (int j = 0; j <= 10; ++j) {
      surfels.vertices.emplace_back(0.1 * i, 0.1 * j, 0.01);
      surfels.normals.emplace_back(0, 0, 1);
      surfels.radii_m.push_back(0.05F);
    }
  }
  return surfels;
}

/// The square of which the points above are the vertices.
PreciseMesh square() {
  PreciseMesh mesh;
  for (const Vector3d& above : surfels_above_square().vertices)
    mesh.vertices.emplace_back(above.x(), above.y(), 0);
  for (std::uint32_t i = 0; i < 10; ++i) {
    for (std::uint32_t j = 0; j < 10; ++j) {
      const std::uint32_t a = 11 * i + j;
      mesh.triangles.push_back({a, a + 11, a + 12});
      mesh.triangles.push_back({a, a + 12, a + 1});
    }
  }
  return mesh;
}

TEST(MeshEvaluation, MeasuresSurfelsAtTheirCentres) {
  const Workers workers(1);
  MeshRequest request{.vertex_errors = true};
  request.errors.reconstruction = {MeshSamples::vertices, 0, 0};
  const auto result = evaluate_mesh(surfels_above_square(), square(), request, workers);
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_EQ(result->reconstruction_samples, 121U);
  EXPECT_EQ(result->reconstruction.vertices, 121U);
  EXPECT_TRUE(result->reconstruction.surfels);
  EXPECT_EQ(result->vertex_errors_m.size(), 121U);
  EXPECT_NEAR(result->errors.accuracy.stats.max, 0.01, 1e-12);
  EXPECT_NEAR(result->surfreg.vertex_mean_m, 0.01, 1e-12);
  EXPECT_NEAR(result->reconstruction.extent_m.x(), 1, 1e-12) << "discs do not count in the size";
  EXPECT_NEAR(result->errors.completeness.stats.mean, 0.01, 0.01) << "discs are the surface";
}

TEST(MeshEvaluation, LeavesVerticesOfNoTriangleOutOfTheSize) {
  const Workers workers(1);
  MeshRequest request;
  request.errors.reconstruction = request.errors.truth = {MeshSamples::vertices, 0, 0};
  PreciseMesh reconstruction = square();
  reconstruction.vertices.emplace_back(500, 0, 0);
  reconstruction.vertices.emplace_back(0, 700, 0);
  PreciseMesh truth = square();
  truth.vertices.emplace_back(0, 0, -900);
  const auto result = evaluate_mesh(reconstruction, truth, request, workers);
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_EQ(result->reconstruction.unused_vertices, 2U);
  EXPECT_EQ(result->truth.unused_vertices, 1U);
  EXPECT_EQ(result->reconstruction_samples, 123U) << "as CloudCompare takes them";
  EXPECT_NEAR(result->errors.accuracy.stats.max, 699, 1e-9);
  EXPECT_NEAR(result->reconstruction.extent_m.norm(), std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace fusebench
