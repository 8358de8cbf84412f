#include "eval/mesh_error/mesh_evaluation.hpp"

#include <gtest/gtest.h>

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
  EXPECT_NE(loose->icp_doubt.find("m (rms) from the truth"), std::string::npos) << loose->icp_doubt;
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
  EXPECT_NE(refused.error().message.find("% of the true surface is observed"), std::string::npos);
}

TEST(MeshEvaluation, DistancesOfVerticesOnRequest) {
  const Workers workers(1);
  const auto result = evaluate_mesh(sphere(1.02, 40), sphere(1, 40), {.vertex_errors = true}, workers);
  ASSERT_TRUE(result.has_value());
  ASSERT_EQ(result->vertex_errors_m.size(), sphere(1.02, 40).vertices.size());
  for (const double error_m : result->vertex_errors_m) EXPECT_NEAR(error_m, 0.02, 1e-4);  // facets are flat
}

}  // namespace
}  // namespace fusebench
