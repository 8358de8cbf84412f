#include "eval/mesh_metrics.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "core/mesh_file.hpp"
#include "eval/pose_alignment.hpp"

namespace fusebench {
namespace {

const std::filesystem::path kVectors =
    std::filesystem::path(__FILE__).parent_path().parent_path() / "golden" / "mesh";

Eigen::Vector3f random_point(std::mt19937_64& random, float size) {
  std::uniform_real_distribution<float> uniform(-size, size);
  return {uniform(random), uniform(random), uniform(random)};
}

/// Triangles of all sizes, among them slivers, needles and points.
Mesh triangle_soup(std::size_t count) {
  std::mt19937_64 random(3);
  Mesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f a = random_point(random, 1);
    Eigen::Vector3f b = a + random_point(random, i % 3 == 0 ? 0.5F : 0.05F);
    Eigen::Vector3f c = a + random_point(random, 0.1F);
    if (i % 10 == 1) c = a + 0.3F * (b - a) + random_point(random, 1e-5F);  // a sliver
    if (i % 10 == 2) c = a + 0.25F * (b - a);                               // no area
    if (i % 10 == 3) b = a;                                                 // a line
    if (i % 50 == 4) b = c = a;                                             // a point
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Another way to a distance: the foot on the plane by its normal equations, or the best of the edges.
double reference_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const auto to_edge = [&](const Vector3d& from, const Vector3d& to) {
    if (from == to) return (p - from).norm();
    const Eigen::ParametrizedLine<double, 3> line(from, (to - from).normalized());
    const double along = line.direction().dot(p - from);
    if (along <= 0) return (p - from).norm();
    if (along >= (to - from).norm()) return (p - to).norm();
    return (p - line.pointAt(along)).norm();
  };
  double best = std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
  Eigen::Matrix<double, 3, 2> edges;
  edges << b - a, c - a;
  const Eigen::Matrix2d square = edges.transpose() * edges;
  if (square.determinant() > 1e-18) {
    const Vector2d uv = square.inverse() * (edges.transpose() * (p - a));
    if (uv.minCoeff() >= 0 && uv.sum() <= 1) best = std::min(best, (p - a - edges * uv).norm());
  }
  return best;
}

double brute_force(const Mesh& mesh, const Vector3d& point) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : mesh.triangles) {
    best =
        std::min(best, reference_distance(point, mesh.vertices[i].cast<double>(),
                                          mesh.vertices[j].cast<double>(), mesh.vertices[k].cast<double>()));
  }
  return best;
}

/// A sphere of triangles whose corners lie on it.
Mesh sphere(float radius_m, int rings) {
  Mesh mesh;
  const int sides = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sides; ++j) {
      const double polar = M_PI * i / rings;
      const double turn = 2 * M_PI * j / sides;
      mesh.vertices.push_back(radius_m * Vector3d(std::sin(polar) * std::cos(turn),
                                                  std::sin(polar) * std::sin(turn), std::cos(polar))
                                             .cast<float>());
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * sides + j % sides); };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sides; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

MeshErrorOptions vertices_only(std::vector<double> thresholds_m = {0.01}) {
  const MeshSampling all{MeshSamples::vertices, 0, 0};
  return {all, all, std::move(thresholds_m)};
}

TEST(TriangleTree, EqualsASearchThroughAllTriangles) {
  const Mesh mesh = triangle_soup(600);
  const TriangleTree tree(mesh);
  std::mt19937_64 random(5);
  NearestTriangle hint;
  for (int i = 0; i < 3000; ++i) {
    Vector3d point = random_point(random, i % 2 == 0 ? 1.0F : 5.0F).cast<double>();
    if (i % 7 == 0) point = mesh.vertices[static_cast<std::size_t>(i) % mesh.vertices.size()].cast<double>();
    const double distance = std::sqrt(tree.nearest(point).squared_m2);
    EXPECT_NEAR(distance, brute_force(mesh, point), 1e-9) << point.transpose();
    hint = tree.nearest(point, hint);  // the hint is of another place
    EXPECT_EQ(std::sqrt(hint.squared_m2), distance);
  }
}

TEST(TriangleTree, RegionsOfOneTriangle) {
  const std::array<Vector3d, 3> t = {Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(0, 1, 0)};
  EXPECT_DOUBLE_EQ(squared_distance_to_triangle({0.5, 0.25, -3}, t), 9);  // inside, from below
  EXPECT_DOUBLE_EQ(squared_distance_to_triangle({1, -2, 0}, t), 4);       // an edge
  EXPECT_DOUBLE_EQ(squared_distance_to_triangle({5, 0, 4}, t), 25);       // a corner
  EXPECT_DOUBLE_EQ(squared_distance_to_triangle({2, 1, 0}, t), 0.8);      // the long edge
  EXPECT_EQ(squared_distance_to_triangle({0.5, 0.25, 0}, t), 0);
}

TEST(TriangleTree, KnowsWhatIsInTheWay) {
  const Mesh mesh = triangle_soup(400);
  const TriangleTree tree(mesh);
  std::mt19937_64 random(9);
  int crossed = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d from = random_point(random, 1.5F).cast<double>();
    const Vector3d to = random_point(random, 1.5F).cast<double>();
    bool expected = false;
    for (const auto& [a, b, c] : mesh.triangles) {
      Matrix3d system;  // from + x (to - from) = a + y (b - a) + z (c - a)
      const Vector3d corner = mesh.vertices[a].cast<double>();
      system << from - to, mesh.vertices[b].cast<double>() - corner, mesh.vertices[c].cast<double>() - corner;
      const Vector3d x = system.fullPivLu().solve(from - corner);
      if ((system * x - (from - corner)).norm() > 1e-9) continue;
      expected = expected || (x.minCoeff() >= 0 && x[0] <= 1 && x[1] + x[2] <= 1);
    }
    EXPECT_EQ(tree.blocked(from, to), expected);
    crossed += expected ? 1 : 0;
  }
  EXPECT_GT(crossed, 200);
  EXPECT_LT(crossed, 1800);
}

TEST(TriangleTree, LinesAlongAnAxisAndThroughAPlane) {
  Mesh wall;
  wall.vertices = {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  const TriangleTree tree(wall);
  EXPECT_TRUE(tree.blocked({0, 0.1, 0.2}, {2, 0.1, 0.2}));
  EXPECT_TRUE(tree.blocked({2, 0.1, 0.2}, {0, 0.1, 0.2}));
  EXPECT_FALSE(tree.blocked({0, 0.1, 0.2}, {0.99, 0.1, 0.2}));
  EXPECT_FALSE(tree.blocked({0, 0.1, 1.2}, {2, 0.1, 1.2}));
  EXPECT_FALSE(tree.blocked({0, 0, 0}, {0, 5, 0}));
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
    // The vectors have nine decimals in double precision; a Mesh has float.
    const auto compare = [](const MeshDistances& got, const nlohmann::json& want) {
      EXPECT_NEAR(got.stats.mean, want.at("mean"), 2e-7);
      EXPECT_NEAR(got.stats.rmse, want.at("rmse"), 2e-7);
      EXPECT_NEAR(got.stats.median, want.at("median"), 2e-7);
      EXPECT_NEAR(got.stats.std, want.at("std"), 2e-7);
      EXPECT_NEAR(got.stats.max, want.at("max"), 2e-7);
      EXPECT_NEAR(got.p95, want.at("p95_linear"), 2e-7);
    };
    compare(result.accuracy, wanted.at("accuracy_vertex_to_mesh"));
    compare(result.completeness, wanted.at("completeness_gtvertex_to_mesh"));
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
  const Mesh truth = sphere(1.0F, 20);
  const SE3 T_truth_reconstruction{so3_exp({0.4, -0.2, 1.0}), {3, -2, 0.5}};
  Mesh reconstruction = sphere(1.01F, 20);
  for (Eigen::Vector3f& vertex : reconstruction.vertices) {
    vertex = (T_truth_reconstruction.inverse() * Vector3d(vertex.cast<double>())).cast<float>();
  }
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

TEST(MeshMetrics, SameNumbersWithAnyThreadCount) {
  const Mesh a = triangle_soup(300);
  const Mesh b = sphere(0.7F, 12);
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

TEST(MeshSampling, SpreadsEvenlyOverTheArea) {
  Mesh mesh;  // a unit square, three quarters of it in one large triangle and a quarter in many small ones
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

TEST(ObservedPoints, ACameraSeesTheCapOfASphere) {
  const Mesh mesh = sphere(1.0F, 60);
  const TriangleTree tree(mesh);
  const auto points = sample_mesh(mesh, {MeshSamples::area, 20'000, 1});
  const Workers workers(2);
  MeshViews views{{640, 480, 400, 400, 319.5, 239.5}, 0.1, 10, {{Quaterniond::Identity(), {0, 0, -3}}}};
  const auto share = [&] {
    return static_cast<double>(observed_points(*points, tree, views, workers).size()) /
           static_cast<double>(points->size());
  };
  // Up to the tangent, at height -r^2 / d, is (1 - r / d) / 2 of the area; the centimetre of the point's own
  // surface adds a little at the rim.
  EXPECT_NEAR(share(), (1 - 1.0 / 3) / 2, 0.03);
  EXPECT_GT(share(), (1 - 1.0 / 3) / 2 - 0.005);
  views.T_truth_camera.push_back({so3_exp({M_PI, 0, 0}), {0, 0, 3}});  // and from behind
  EXPECT_NEAR(share(), 1 - 1.0 / 3, 0.06);
  views.max_depth_m = 2.1;  // the foremost caps of 0.1 m height: 0.1 / (2 r) of the area each
  EXPECT_NEAR(share(), 0.1, 0.005);
  views.camera.width_px = 320;  // the left half of the image
  EXPECT_NEAR(share(), 0.05, 0.005);
  views.T_truth_camera = {{Quaterniond::Identity(), {0, 0, 3}}};  // looking away
  EXPECT_EQ(share(), 0);
}

TEST(MeshMetrics, UselessMeshesAreRefused) {
  const Mesh good = sphere(1.0F, 8);
  const Workers workers(1);
  const auto message = [&](const Mesh& reconstruction, const Mesh& truth,
                           const std::optional<MeshViews>& views = {}) {
    const auto comparison = MeshComparison::create(reconstruction, truth, views, {}, workers);
    if (comparison) return std::string("was not refused");
    EXPECT_EQ(comparison.error().code, ErrorCode::data_corrupt);
    return comparison.error().message;
  };
  EXPECT_EQ(message({}, good), "the reconstruction has no triangles (0 vertices)");
  Mesh points = good;
  points.triangles.clear();
  EXPECT_TRUE(message(good, points).starts_with("the truth has no triangles"));
  Mesh not_finite = good;
  not_finite.vertices[5].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(message(not_finite, good).starts_with("the reconstruction: vertex 5 is not finite"));
  Mesh torn = good;
  torn.triangles[2][1] = 100'000;
  EXPECT_NE(message(good, torn).find("names vertex 100000"), std::string::npos);
  EXPECT_NE(message(good, good, MeshViews{{10, 10, 10, 10, 4.5, 4.5}, 0, 1, {}}).find("is seen"),
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

TEST(AlignPoses, IsExactWithoutNoiseAlsoForACameraAtRest) {
  const SE3 T_reference_estimate{so3_exp({2.0, -1.0, 0.5}), {5, -3, 1}};
  std::vector<SE3> reference;
  std::vector<SE3> estimate;
  for (int i = 0; i < 20; ++i) {
    estimate.push_back({so3_exp({0.1 * i, 0.02 * i * i, -0.3}), {1, 2, 3}});  // turns on the spot
    reference.push_back(T_reference_estimate * estimate.back());
  }
  const auto aligned = align_poses(reference, estimate);
  ASSERT_TRUE(aligned.has_value());
  EXPECT_LT(rotation_angle_rad(aligned->rotation, T_reference_estimate.rotation), 1e-12);
  EXPECT_LT((aligned->translation - T_reference_estimate.translation).norm(), 1e-12);
  EXPECT_FALSE(align_poses({}, {}).has_value());
}

TEST(AlignPoses, AveragesErrorsOfOrientation) {
  std::vector<SE3> reference;
  std::vector<SE3> estimate;
  for (int i = 0; i < 10; ++i) {  // errors of opposite sign in pairs
    const Quaterniond exact = so3_exp({0.3 * i, 0, 0.1});
    reference.push_back({exact, {0, 0, 0.1 * i}});
    estimate.push_back({so3_exp({0, i % 2 == 0 ? 0.02 : -0.02, 0}) * exact, {0, 0, 0.1 * i}});
  }
  const auto aligned = align_poses(reference, estimate);
  ASSERT_TRUE(aligned.has_value());
  EXPECT_LT(rotation_angle_rad(aligned->rotation, Quaterniond::Identity()), 1e-12);
  EXPECT_LT(aligned->translation.norm(), 1e-12);
  // Half turns about three axes have no mean.
  const std::vector<SE3> contradicting = {{Quaterniond(1, 0, 0, 0), {}},
                                          {Quaterniond(0, 1, 0, 0), {}},
                                          {Quaterniond(0, 0, 1, 0), {}},
                                          {Quaterniond(0, 0, 0, 1), {}}};
  EXPECT_FALSE(align_poses(contradicting, std::vector<SE3>(4)).has_value());
}

}  // namespace
}  // namespace fusebench
