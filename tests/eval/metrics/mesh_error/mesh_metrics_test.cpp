#include "eval/metrics/mesh_error/mesh_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/mesh/ply_file.hpp"
#include "eval/metrics/mesh_error/vertex_tree.hpp"
#include "tests/support/expect_close.hpp"
#include "tests/support/repository.hpp"
#include "tests/support/test_meshes.hpp"

namespace fusebench {

using namespace mesh;
using namespace trajectory_error;
using namespace mesh_error;

namespace {

using testing::expect_close;
using testing::sphere;
using testing::triangle_soup;

const std::filesystem::path kVectors = testing::repository_root() / "tests" / "golden" / "mesh";

MeshErrorOptions vertices_only(std::vector<double> thresholds_m = {0.01}) {
  const MeshSampling all{MeshSamples::vertices, 0, 0};
  return {all, all, std::move(thresholds_m)};
}

TEST(MeshMetrics, VectorsOfAnIndependentImplementation) {
  const auto expected = nlohmann::json::parse(std::ifstream(kVectors / "expected.json"));
  const Workers workers(1);
  ASSERT_EQ(expected.at("cases").size(), 5U);
  for (const auto& wanted : expected.at("cases")) {
    const std::string id = wanted.at("id");
    SCOPED_TRACE(id);
    const auto reconstruction = read_ply(kVectors / wanted.at("rec").get<std::string>());
    const auto truth = read_ply(kVectors / wanted.at("gt").get<std::string>());
    ASSERT_TRUE(reconstruction && truth);
    std::vector<double> thresholds_m;
    for (const auto& at : wanted.at("thresholds")) thresholds_m.push_back(at.at("tau"));
    const auto comparison =
        MeshComparison::create(*reconstruction, *truth, std::nullopt, vertices_only(thresholds_m), workers);
    ASSERT_TRUE(comparison.has_value()) << comparison.error().message;
    const MeshErrorResult result = comparison->evaluate({}, workers);
    const auto compare = [](const MeshDistances& got, const nlohmann::json& want) {
      expect_close(got.stats.mean, want.at("mean"), "mean");
      expect_close(got.stats.rmse, want.at("rmse"), "rmse");
      expect_close(got.stats.median, want.at("median"), "median");
      expect_close(got.stats.std, want.at("std"), "std");
      expect_close(got.stats.min, want.at("min"), "min");
      expect_close(got.stats.max, want.at("max"), "max");
      expect_close(got.p95, want.at("p95_linear"), "p95");
    };
    compare(result.accuracy, wanted.at("accuracy_vertex_to_mesh"));
    compare(result.completeness, wanted.at("completeness_gtvertex_to_mesh"));
    const SurfregScore surfreg =
        surfreg_score(reconstruction->vertices, VertexTree(truth->vertices), workers);
    expect_close(surfreg.vertex_mean_m, wanted.at("surfreg_score_vertex_to_vertex_mean"), "SurfReg");
    const std::vector<double> to_truth_m =
        distances_m(reconstruction->vertices, {}, comparison->truth(), workers);
    for (std::size_t i = 0; i < wanted.at("accuracy_first5").size(); ++i)
      expect_close(to_truth_m[i], wanted.at("accuracy_first5")[i], "a distance");
    EXPECT_EQ(result.accuracy.stats.count, wanted.at("n_rec_vertices"));
    EXPECT_EQ(result.completeness.stats.count, wanted.at("n_gt_vertices"));
    for (std::size_t i = 0; i < thresholds_m.size(); ++i) {
      const auto& at = wanted.at("thresholds")[i];
      // All distances of this case are the threshold but for rounding.
      if (id == "sphere_offset" && thresholds_m[i] == 0.01) continue;
      EXPECT_NEAR(result.thresholds[i].precision, at.at("precision_mesh"), 1e-12) << thresholds_m[i];
      EXPECT_NEAR(result.thresholds[i].recall, at.at("recall_mesh"), 1e-12) << thresholds_m[i];
      EXPECT_NEAR(result.thresholds[i].fscore, at.at("fscore_mesh"), 1e-12) << thresholds_m[i];
    }
  }
}

TEST(MeshMetrics, AlignmentMovesTheReconstruction) {
  const PreciseMesh truth = sphere(1.0, 20);
  const SE3 T_truth_reconstruction{so3_exp({0.4, -0.2, 1.0}), {3, -2, 0.5}};
  PreciseMesh reconstruction = sphere(1.01, 20);
  for (Vector3d& vertex : reconstruction.vertices) vertex = T_truth_reconstruction.inverse() * vertex;
  const Workers workers(1);
  const auto comparison = MeshComparison::create(reconstruction, truth, std::nullopt, {}, workers);
  ASSERT_TRUE(comparison.has_value());
  const MeshErrorResult result = comparison->evaluate({"se3", T_truth_reconstruction}, workers);
  EXPECT_NEAR(result.accuracy.stats.mean, 0.01, 1e-4);
  EXPECT_NEAR(result.completeness.stats.mean, 0.01, 1e-4);
  EXPECT_EQ(result.thresholds[1].tau_m, 0.01);
  EXPECT_EQ(result.thresholds[2].fscore, 1);
  EXPECT_NEAR(result.chamfer_m, 0.01, 1e-4);
  EXPECT_GT(comparison->evaluate({}, workers).accuracy.stats.mean, 1);  // and without, they are apart
}

/// From two sides a sphere around the true one hides nothing of itself behind it.
TEST(MeshMetrics, GhostsStandInFreeSpaceBeforeTheTruth) {
  const PreciseMesh truth = sphere(1.0, 40);
  const Workers workers(1);
  const MeshViews views{{640, 480, 400, 400, 319.5, 239.5},
                        0.1,
                        10,
                        {{Quaterniond::Identity(), {0, 0, -3}}, {so3_exp({M_PI, 0, 0}), {0, 0, 3}}}};
  const auto ghosts = [&](double radius_m, const std::optional<MeshViews>& seen_from) {
    const auto comparison = MeshComparison::create(sphere(radius_m, 40), truth, seen_from, {}, workers);
    return comparison->evaluate({}, workers).ghost_share;
  };
  EXPECT_NEAR(ghosts(1.1, views).value(), 1, 0.01);
  EXPECT_EQ(ghosts(1.02, views).value(), 0) << "within three centimetres";
  EXPECT_EQ(ghosts(0.9, views).value(), 0) << "behind the surface, where no camera looks";
  EXPECT_FALSE(ghosts(1.1, std::nullopt)) << "nobody says from where the truth was seen";
}

TEST(MeshMetrics, SameNumbersWithAnyThreadCount) {
  const PreciseMesh a = triangle_soup(300);
  const PreciseMesh b = sphere(0.7, 12);
  const MeshViews views{{64, 48, 60, 60, 31.5, 23.5}, 0, 10, {{so3_exp({0, 0.3, 0}), {0, 0, -3}}}};
  const auto run = [&](int threads) {
    const Workers workers(threads);
    const auto comparison = MeshComparison::create(a, b, views, {}, workers);
    return comparison->evaluate({}, workers);
  };
  const MeshErrorResult one = run(1);
  const MeshErrorResult three = run(3);
  EXPECT_EQ(one.accuracy.stats.mean, three.accuracy.stats.mean);
  EXPECT_EQ(one.completeness.stats.sse, three.completeness.stats.sse);
  EXPECT_EQ(one.completeness.stats.count, three.completeness.stats.count);
}

TEST(MeshMetrics, UselessMeshesAreRefused) {
  const PreciseMesh good = sphere(1.0, 8);
  const Workers workers(1);
  const auto message = [&](const PreciseMesh& reconstruction, const PreciseMesh& truth,
                           const std::optional<MeshViews>& views = {}) {
    const auto comparison = MeshComparison::create(reconstruction, truth, views, {}, workers);
    if (comparison) return std::string("was not refused");
    EXPECT_EQ(comparison.error().code, ErrorCode::data_corrupt);
    return comparison.error().message;
  };
  EXPECT_EQ(message({}, good), "the reconstruction has no triangles (0 vertices)");
  PreciseMesh points = good;
  points.triangles.clear();
  EXPECT_TRUE(message(good, points).starts_with("the ground truth has no triangles"));
  PreciseMesh not_finite = good;
  not_finite.vertices[5].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(message(not_finite, good).starts_with("the reconstruction: vertex 5 is at "));
  EXPECT_NE(message(not_finite, good).find(" nan "), std::string::npos);
  PreciseMesh far = good;
  far.vertices[5].y() = 1e200;  // its square is infinite
  EXPECT_TRUE(message(good, far).starts_with("the ground truth: vertex 5 is at "));
  EXPECT_TRUE(message(good, far).ends_with("(allowed: coordinates up to 1e+12)"));
  PreciseMesh torn = good;
  torn.triangles[2][1] = 100'000;
  EXPECT_NE(message(good, torn).find("names vertex 100000"), std::string::npos);
  EXPECT_NE(message(good, good, MeshViews{{10, 10, 10, 10, 4.5, 4.5}, 0, 1, {}}).find("is visible"),
            std::string::npos);
}

TEST(Percentile, LiesBetweenNeighbours) {
  const std::vector<double> values = {1, 2, 4, 8, 16};
  EXPECT_EQ(percentile(values, 0), 1);
  EXPECT_EQ(percentile(values, 0.5), 4);
  EXPECT_DOUBLE_EQ(percentile(values, 0.9), 8 + 0.6 * 8);
  EXPECT_EQ(percentile(values, 1), 16);
  EXPECT_EQ(percentile(std::vector<double>{3}, 0.95), 3);
}

}  // namespace
}  // namespace fusebench
