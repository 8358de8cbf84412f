#include "eval/metrics/mesh_error/mesh_views.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "eval/metrics/mesh_error/mesh_sampling.hpp"
#include "tests/support/test_meshes.hpp"

namespace fusebench {

using namespace mesh_error;

namespace {

using testing::sphere;

TEST(ObservedPoints, ACameraSeesTheCapOfASphere) {
  const PreciseMesh mesh = sphere(1.0, 60);
  const TriangleTree tree(mesh, Workers(1));
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

TEST(ObservedPoints, TheFrustumSeesThroughWalls) {
  const PreciseMesh mesh = sphere(1.0, 60);
  const TriangleTree tree(mesh, Workers(1));
  const Workers workers(2);
  MeshViews views{{640, 480, 400, 400, 319.5, 239.5}, 0.1, 10, {{Quaterniond::Identity(), {0, 0, -3}}}};
  views.culling = Culling::frustum;
  EXPECT_EQ(observed_points(mesh.vertices, tree, views, workers).size(), mesh.vertices.size());
}

TEST(ObservedPoints, AMeasuredDepthHidesWhatIsBehindIt) {
  const PreciseMesh mesh = sphere(1.0, 8);
  const TriangleTree tree(mesh, Workers(1));
  const Workers workers(1);
  MeshViews views{{64, 48, 40, 40, 31.5, 23.5}, 0.1, 10, {SE3{}}};
  views.culling = Culling::depth;
  DepthImage depth_m(64, 48, 2.0F);
  depth_m(31, 23) = 0;  // not measured
  views.depth_m = {depth_m};
  const std::vector<Vector3d> points = {{0.2, 0, 2.0}, {0.2, 0, 2.039},   {0.2, 0, 2.041},
                                        {0.2, 0, 1.5}, {-0.02, -0.02, 2}, {9, 0, 2}};
  // On the surface, 3.9 cm and 4.1 cm behind (2 % of 2 m are 4 cm), before it, not measured, outside.
  EXPECT_EQ(observed_points(points, tree, views, workers), (std::vector<std::size_t>{0, 1, 3}));
  views.depth_m[0] = DepthImage(64, 48, 0.5F);
  const std::vector<Vector3d> near = {{0, 0, 0.529}, {0, 0, 0.531}};  // 3 cm where 2 % are less
  EXPECT_EQ(observed_points(near, tree, views, workers), (std::vector<std::size_t>{0}));
}

}  // namespace
}  // namespace fusebench
