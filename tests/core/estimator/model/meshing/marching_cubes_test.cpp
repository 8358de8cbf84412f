#include "core/estimator/model/meshing/marching_cubes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "core/estimator/model/meshing/marching_cubes_table.hpp"
#include "tests/support/fused_scene.hpp"
#include "tests/support/plain_field.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace tsdf;
using namespace meshing;

namespace {

const PinholeCamera kMarchCamera = test_camera(320, 240, 60.0);
constexpr double kMinWeight = 1.0;

using Edge = std::pair<std::uint64_t, std::uint64_t>;

// Number of occurrences of each directed edge. In a closed, consistently oriented surface: once, and its
// reverse once.
template <class Triangles>
std::map<Edge, int> directed_edges(const Triangles& triangles) {
  std::map<Edge, int> edges;
  for (const auto& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{triangle[i], triangle[(i + 1) % 3]}];
  }
  return edges;
}

template <class Triangles>
int open_or_repeated_edges(const Triangles& triangles) {
  const std::map<Edge, int> edges = directed_edges(triangles);
  int bad = 0;
  for (const auto& [edge, count] : edges) {
    const auto reverse = edges.find({edge.second, edge.first});
    if (count != 1 || reverse == edges.end() || reverse->second != 1) ++bad;
  }
  return bad;
}

struct Accuracy {
  double mean_m = 0;
  double max_m = 0;
  double mean_normal_dot = 0;
  std::size_t vertices = 0;
};

// Distance of the vertices accepted by `counts` to the surface of the scene.
template <class Counts>
Accuracy accuracy(const Mesh& mesh, const AnalyticScene& scene, const Counts& counts) {
  Accuracy result;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d vertex = mesh.vertices[i].cast<double>();
    if (!counts(vertex)) continue;
    const double error_m = std::abs(scene.distance_m(vertex));
    result.mean_m += error_m;
    result.max_m = std::max(result.max_m, error_m);
    result.mean_normal_dot += scene.normal_at(vertex).dot(mesh.normals[i].cast<double>());
    ++result.vertices;
  }
  result.mean_m /= static_cast<double>(result.vertices);
  result.mean_normal_dot /= static_cast<double>(result.vertices);
  return result;
}

// Share of the triangles whose counter-clockwise side is that of the analytic normal (slivers do not count).
double share_facing_out(const Mesh& mesh, const AnalyticScene& scene) {
  int out = 0, all = 0;
  for (const auto& triangle : mesh.triangles) {
    const Vector3d a = mesh.vertices[triangle[0]].cast<double>();
    const Vector3d b = mesh.vertices[triangle[1]].cast<double>();
    const Vector3d c = mesh.vertices[triangle[2]].cast<double>();
    const Vector3d area = (b - a).cross(c - a);
    if (area.norm() < 1e-7) continue;
    ++all;
    out += area.dot(scene.normal_at((a + b + c) / 3.0)) > 0 ? 1 : 0;
  }
  return static_cast<double>(out) / all;
}

bool same_bytes(const Mesh& a, const Mesh& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  return same(a.vertices, b.vertices) && same(a.normals, b.normals) && same(a.colors, b.colors) &&
         same(a.triangles, b.triangles);
}

TEST(MarchingCubesTable, UsesExactlyTheCrossedEdges) {
  for (unsigned pattern = 0; pattern < 256; ++pattern) {
    std::set<int> crossed, used;
    for (int e = 0; e < 12; ++e) {
      const CellEdge edge = cell_edges()[static_cast<std::size_t>(e)];
      const unsigned to = edge.from | 1U << edge.axis;
      if (((pattern >> edge.from) & 1U) != ((pattern >> to) & 1U)) crossed.insert(e);
    }
    for (const CellTriangle& triangle : cell_triangles()[pattern])
      used.insert(triangle.begin(), triangle.end());
    EXPECT_EQ(used, crossed) << pattern;
  }
}

TEST(MarchingCubesTable, CutsACornerOffFacingOut) {
  // Corner 0 inside: the triangle's normal points along (1, 1, 1), into free space.
  ASSERT_EQ(cell_triangles()[1].size(), 1U);
  std::array<Vector3d, 3> corner;
  for (std::size_t i = 0; i < 3; ++i) {
    const CellEdge edge = cell_edges()[cell_triangles()[1][0][i]];
    ASSERT_EQ(edge.from, 0);
    corner[i] = 0.5 * Vector3d::Unit(edge.axis);
  }
  EXPECT_GT((corner[1] - corner[0]).cross(corner[2] - corner[0]).dot(Vector3d::Ones()), 0.0);
}

TEST(MarchingCubesTable, IsClosedAndOrientedOnRandomSigns) {
  // All 256 patterns, and all ambiguous neighbours, occur in grids of random signs; the border is outside.
  constexpr int kSide = 24;
  std::mt19937 random(7);
  for (const unsigned share_of_ten : {2U, 5U, 8U}) {
    std::vector<bool> inside(kSide * kSide * kSide, false);
    const auto at = [](int x, int y, int z) { return static_cast<std::size_t>(x + kSide * (y + kSide * z)); };
    for (int z = 1; z < kSide - 1; ++z) {
      for (int y = 1; y < kSide - 1; ++y) {
        for (int x = 1; x < kSide - 1; ++x) inside[at(x, y, z)] = random() % 10 < share_of_ten;
      }
    }
    std::vector<std::array<std::uint64_t, 3>> triangles;
    std::set<unsigned> patterns;
    for (int z = 0; z + 1 < kSide; ++z) {
      for (int y = 0; y + 1 < kSide; ++y) {
        for (int x = 0; x + 1 < kSide; ++x) {
          unsigned pattern = 0;
          for (int c = 0; c < 8; ++c) {
            pattern |= inside[at(x + (c & 1), y + ((c >> 1) & 1), z + (c >> 2))] ? 1U << c : 0U;
          }
          patterns.insert(pattern);
          for (const CellTriangle& triangle : cell_triangles()[pattern]) {
            std::array<std::uint64_t, 3> vertices{};
            for (std::size_t i = 0; i < 3; ++i) {
              const CellEdge edge = cell_edges()[triangle[i]];
              vertices[i] =
                  3 * at(x + (edge.from & 1), y + ((edge.from >> 1) & 1), z + (edge.from >> 2)) + edge.axis;
            }
            triangles.push_back(vertices);
          }
        }
      }
    }
    if (share_of_ten == 5) {
      EXPECT_EQ(patterns.size(), 256U);
    }
    EXPECT_GT(triangles.size(), 10000U);
    EXPECT_EQ(open_or_repeated_edges(triangles), 0);
  }
}

TEST(MarchingCubes, ClosesABall) {
  const AnalyticScene scene = ball_scene();
  const TsdfVolume volume = fuse(scene, kMarchCamera, poses_around_ball());
  const Mesh mesh = extract_mesh(volume, kMinWeight, Workers(2));
  ASSERT_GT(mesh.vertices.size(), 10000U);
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());

  EXPECT_EQ(open_or_repeated_edges(mesh.triangles), 0);
  // Euler: V - E + F = 2, with E = 3 F / 2 in a closed surface. One sphere, no second skin, no unused vertex.
  EXPECT_EQ(2 * mesh.vertices.size(), mesh.triangles.size() + 4);

  const Accuracy result = accuracy(mesh, scene, [](const Vector3d&) { return true; });
  EXPECT_LT(result.mean_m, 0.25 * volume.voxel_m());
  EXPECT_LT(result.max_m, volume.voxel_m());
  EXPECT_GT(result.mean_normal_dot, 0.99);
  EXPECT_GT(share_facing_out(mesh, scene), 0.995);
  for (const Eigen::Vector3f& normal : mesh.normals) ASSERT_NEAR(normal.norm(), 1.0F, 1e-5F);
  for (const Rgb& color : mesh.colors) ASSERT_EQ(color, (Rgb{180, 90, 30}));
}

constexpr double kWallDepth_m = 1.0037;  // not a multiple of the voxel

/// A wall at this depth of a camera at the origin that looks along a direction. The depth of every pixel is
/// the same, so that the projective distance of a voxel is its distance to the wall. Voxels are 2 cm.
Mesh mesh_of_wall(const Vector3d& direction) {
  RgbdFrame frame;
  frame.depth_m = DepthImage(kMarchCamera.width_px, kMarchCamera.height_px, static_cast<float>(kWallDepth_m));
  TsdfVolume volume{TsdfConfig{.voxel_m = 0.02, .truncation_m = 0.08}};
  EXPECT_TRUE(
      volume.integrate(frame, kMarchCamera, look_at({0, 0, 0}, direction), DepthConfig{}, Workers(1)));
  return extract_mesh(volume, 0.5, Workers(1));
}

// The distance is linear along each lattice edge, so its zero is exact. The rest is the rounding of stored
// distances, 2^-11 of up to a voxel, and single precision.
TEST(MarchingCubes, PutsTheVerticesOfAWallOntoIt) {
  for (const Vector3d& direction :
       {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0), Vector3d(0, 0, 1),
        Vector3d(0, 0, -1), Vector3d(1, 1, 1), Vector3d(-3, 1, 2), Vector3d(0.2, -0.3, 1)}) {
    const Vector3d normal = direction.normalized();
    const Mesh mesh = mesh_of_wall(direction);
    ASSERT_GT(mesh.vertices.size(), 1000U);
    double worst_voxels = 0;
    double least_dot = 1;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const Vector3d vertex = mesh.vertices[i].cast<double>();
      worst_voxels = std::max(worst_voxels, std::abs(normal.dot(vertex) - kWallDepth_m) / 0.02);
      // The gradient is one-sided at the border of what was seen.
      if (vertex.cross(normal).norm() < 0.3)
        least_dot = std::min(least_dot, -normal.dot(mesh.normals[i].cast<double>()));
    }
    EXPECT_LT(worst_voxels, 0.002) << direction.transpose();
    EXPECT_GT(least_dot, 0.9999) << direction.transpose();
  }
}

// Where the surface is nearly perpendicular to the rays. Between two voxels a sphere of radius R differs from
// its tangent plane by voxel^2 / 8 R: 0.004 voxels. Half a pixel is 0.5 mm, of which the slope makes 0.01
// voxels.
TEST(MarchingCubes, PutsTheVerticesOfASphereOntoIt) {
  const PinholeCamera camera = test_camera(640, 640, 40.0);
  for (const Vector3d& direction : {Vector3d(0, 0, 1), Vector3d(1, 0.01, 0), Vector3d(-2, 1, 3)}) {
    const Vector3d axis = direction.normalized();
    const Vector3d center = 1.5 * axis + Vector3d(0.0037, -0.0021, 0.0073);
    const AnalyticScene scene{{AnalyticSphere{center, 0.6, {1, 2, 3}}}};
    const TsdfConfig tsdf{.voxel_m = 0.02, .truncation_m = 0.08};
    const Mesh mesh = extract_mesh(fuse(scene, camera, {look_at({0, 0, 0}, axis)}, tsdf), 0.5, Workers(1));
    const Accuracy cap = accuracy(mesh, scene, [&](const Vector3d& vertex) {
      return (center - vertex).normalized().dot(axis) > std::cos(0.3);
    });
    EXPECT_GT(cap.vertices, 250U);
    EXPECT_LT(cap.max_m, 0.02 * tsdf.voxel_m) << direction.transpose();
    EXPECT_LT(cap.mean_m, 0.006 * tsdf.voxel_m) << direction.transpose();
  }
}

TEST(MarchingCubes, FollowsABoxFromOutside) {
  const AnalyticScene scene{{AnalyticBox{{-0.251, -0.183, -0.207}, {0.249, 0.211, 0.193}, false, {1, 2, 3}}}};
  const TsdfVolume volume = fuse(scene, kMarchCamera, poses_around({0, 0, 0}, 1.1, 40));
  const Mesh mesh = extract_mesh(volume, kMinWeight, Workers(2));
  const double voxel_m = volume.voxel_m();
  const Accuracy all = accuracy(mesh, scene, [](const Vector3d&) { return true; });
  EXPECT_GT(all.vertices, 10000U);
  EXPECT_LT(all.mean_m, 0.25 * voxel_m);
  EXPECT_LT(all.max_m, 2.0 * voxel_m);
  const auto away_from_edges = [&](const Vector3d& p) {
    const Vector3d low = (p - Vector3d(-0.251, -0.183, -0.207)).cwiseAbs();
    const Vector3d high = (p - Vector3d(0.249, 0.211, 0.193)).cwiseAbs();
    return (low.cwiseMin(high).array() < 0.03).count() == 1;  // near one face only
  };
  const Accuracy faces = accuracy(mesh, scene, away_from_edges);
  EXPECT_GT(faces.vertices, all.vertices / 2);
  EXPECT_LT(faces.mean_m, 0.1 * voxel_m);
  EXPECT_LT(faces.max_m, 0.5 * voxel_m);
  EXPECT_GT(faces.mean_normal_dot, 0.99);
}

TEST(MarchingCubes, FollowsARoomFromInside) {
  const AnalyticScene scene{
      {AnalyticBox{{-1.013, -0.907, -1.111}, {1.009, 0.911, 1.107}, true, {90, 100, 110}}}};
  TsdfConfig tsdf;
  tsdf.voxel_m = 0.02;
  tsdf.truncation_m = 0.08;
  const TsdfVolume volume = fuse(scene, kMarchCamera, poses_looking_out({0.1, -0.05, 0.2}, 40), tsdf);
  const Mesh mesh = extract_mesh(volume, 0.5, Workers(2));
  const Accuracy all = accuracy(mesh, scene, [](const Vector3d&) { return true; });
  EXPECT_GT(all.vertices, 10000U);
  EXPECT_LT(all.mean_m, 0.1 * tsdf.voxel_m);
  EXPECT_LT(all.max_m, 1.0 * tsdf.voxel_m);
  EXPECT_GT(all.mean_normal_dot, 0.98);
  EXPECT_GT(share_facing_out(mesh, scene), 0.98);
}

TEST(MarchingCubes, CarriesTheColourOfEachSurface) {
  const AnalyticScene scene{
      {AnalyticSphere{{-0.4, 0, 1}, 0.25, {250, 10, 20}}, AnalyticSphere{{0.4, 0, 1}, 0.25, {5, 200, 100}}}};
  const Mesh mesh = extract_mesh(fuse(scene, kMarchCamera, {SE3{}, SE3{}}), kMinWeight, Workers(1));
  std::size_t left = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const bool is_left = mesh.vertices[i].x() < 0.0F;
    left += is_left ? 1U : 0U;
    ASSERT_EQ(mesh.colors[i], (is_left ? Rgb{250, 10, 20} : Rgb{5, 200, 100}));
  }
  EXPECT_GT(left, 1000U);
  EXPECT_GT(mesh.vertices.size() - left, 1000U);
}

TEST(MarchingCubes, HasNoColoursWhereNoFrameHadAny) {
  RgbdFrame frame = ball_scene().render(kMarchCamera, poses_around_ball()[0]);
  frame.color = {};
  TsdfVolume volume{TsdfConfig{}};
  ASSERT_TRUE(volume.integrate(frame, kMarchCamera, poses_around_ball()[0], DepthConfig{}, Workers(1)));
  const Mesh mesh = extract_mesh(volume, 0.5, Workers(1));
  EXPECT_GT(mesh.vertices.size(), 1000U);
  EXPECT_TRUE(mesh.colors.empty());
}

TEST(MarchingCubes, LeavesOutWhatWasHardlySeen) {
  const TsdfVolume once = fuse(ball_scene(), kMarchCamera, {poses_around_ball()[0]});
  EXPECT_GT(extract_mesh(once, 0.5, Workers(1)).triangles.size(), 1000U);
  const Mesh none = extract_mesh(once, 2.0, Workers(1));
  EXPECT_TRUE(none.triangles.empty());
  EXPECT_TRUE(none.vertices.empty());
  EXPECT_TRUE(extract_mesh(TsdfVolume{TsdfConfig{}}, 0.0, Workers(1)).vertices.empty());
}

TEST(MarchingCubes, TheLeastWeightIsEnough) {
  const SE3 T_world_camera = look_at({0, 0, 0}, {0.2, -0.3, 1});
  RgbdFrame frame;
  frame.depth_m = DepthImage(kMarchCamera.width_px, kMarchCamera.height_px, 1.0F);
  TsdfVolume volume{TsdfConfig{.voxel_m = 0.02, .truncation_m = 0.08}};
  ASSERT_TRUE(volume.integrate(frame, kMarchCamera, T_world_camera, DepthConfig{}, Workers(1)));
  // In front of the surface, and behind it up to half of the band, a measurement has its whole weight.
  float weight = 0;
  for (std::size_t i = 0; i < volume.block_count() * kBlockVoxels; ++i)
    weight = std::max(weight, static_cast<float>(volume.weights()[i]));
  EXPECT_NEAR(weight, volume.measurement_weight(1.0, DepthConfig{}), 1e-3);
  EXPECT_GT(extract_mesh(volume, weight, Workers(1)).triangles.size(), 1000U);
  EXPECT_TRUE(extract_mesh(volume, 1.001 * weight, Workers(1)).triangles.empty());
}

/// Each vertex is on a lattice edge where the distance changes its sign. Its normal is the mean of the
/// central differences at both ends, weighted by the distances to them.
TEST(MarchingCubes, NormalsAreInterpolatedBetweenTheGradientsOfBothVoxels) {
  const AnalyticScene scene{{AnalyticSphere{{0.0137, -0.0211, 0.0073}, 0.12, {180, 90, 30}}}};
  const TsdfVolume volume = fuse(scene, kMarchCamera, poses_around({0.0137, -0.0211, 0.0073}, 0.8, 24));
  const auto distance_m = [&](const VoxelIndex& at) {
    return static_cast<double>(testing::find_voxel(volume, at).value_or(Voxel{}).distance_m);
  };
  const auto gradient = [&](const VoxelIndex& at) {
    Vector3d sum;
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] = distance_m(at + VoxelIndex::Unit(axis)) - distance_m(at - VoxelIndex::Unit(axis));
    return sum;
  };
  const Mesh mesh = extract_mesh(volume, kMinWeight, Workers(1));
  ASSERT_GT(mesh.vertices.size(), 1000U);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d place = mesh.vertices[i].cast<double>() / volume.voxel_m();
    const Vector3d off = (place.array() - place.array().round()).abs();
    int axis = 0;
    if (off.maxCoeff(&axis) < 1e-3) continue;  // at a voxel
    VoxelIndex low = place.array().round().matrix().cast<int>();
    low[axis] = static_cast<int>(std::floor(place[axis]));
    const double share = place[axis] - low[axis];
    const Vector3d expected = (1 - share) * gradient(low) + share * gradient(low + VoxelIndex::Unit(axis));
    if (!expected.allFinite()) continue;  // one-sided next to what was not observed
    EXPECT_LT((mesh.normals[i].cast<double>() - expected.normalized()).norm(), 1e-3) << place.transpose();
    ++compared;
  }
  EXPECT_GT(2 * compared, mesh.vertices.size());
}

TEST(MarchingCubes, IsTheSameForEveryNumberOfThreads) {
  const TsdfVolume volume = fuse(ball_scene(), kMarchCamera, poses_around_ball());
  const Mesh one = extract_mesh(volume, kMinWeight, Workers(1));
  EXPECT_TRUE(same_bytes(one, extract_mesh(volume, kMinWeight, Workers(2))));
  EXPECT_TRUE(same_bytes(one, extract_mesh(volume, kMinWeight, Workers(8))));
}

TEST(MarchingCubes, DoesNotDependOnTheOrderOfStorage) {
  // Two frames without a block in common, fused in both orders: the same field, stored differently.
  const AnalyticScene scene{
      {AnalyticSphere{{0, 0, 1}, 0.3, {9, 9, 9}}, AnalyticSphere{{0, 0, -1}, 0.3, {9, 9, 9}}}};
  const SE3 ahead = look_at({0, 0, 0}, {0, 0, 1});
  const SE3 behind = look_at({0, 0, 0}, {0, 0, -1});
  // With such small voxels every pixel is used; otherwise the selected pixels depend on the frame number.
  const TsdfConfig tsdf{.voxel_m = 0.006};
  const TsdfVolume first = fuse(scene, kMarchCamera, {ahead, behind}, tsdf);
  const TsdfVolume second = fuse(scene, kMarchCamera, {behind, ahead}, tsdf);
  ASSERT_NE(first.block_indices(), second.block_indices());
  const Mesh mesh = extract_mesh(first, 0.5, Workers(1));
  EXPECT_GT(mesh.triangles.size(), 1000U);
  EXPECT_TRUE(same_bytes(mesh, extract_mesh(second, 0.5, Workers(1))));
}

}  // namespace
}  // namespace fusebench
