#include "eval/mesh_error/mesh_clustering.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::mesh_error {

namespace {

/// What has come together in a cell.
struct Cluster {
  Vector3d position = Vector3d::Zero();
  Vector3d color = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
  double radius_m = 0;
  double quality = 0;
  double count = 0;
};

/// Of a surfel, in place of those of a cell: it reaches the cell's corners, and is no smaller than they were.
void add_disc(PreciseMesh& mesh, const Cluster& cluster, double cell_m) {
  const double length = cluster.normal.norm();
  const Vector3d normal = length > 1e-6 ? Vector3d(cluster.normal / length) : Vector3d(0, 0, 1);
  mesh.normals.push_back(normal.cast<float>());
  mesh.radii_m.push_back(
      static_cast<float>(std::max(cluster.radius_m / cluster.count, cell_m / std::sqrt(2.0))));
}

std::size_t parts_of(const PreciseMesh& mesh) {
  return mesh.radii_m.empty() ? mesh.triangles.size() : mesh.vertices.size();
}

}  // namespace

PreciseMesh clustered(const PreciseMesh& mesh, double cell_m) {
  check(cell_m > 0, "a cell has a size");
  std::map<std::array<std::int64_t, 3>, std::uint32_t> numbers;
  std::vector<Cluster> clusters;
  std::vector<std::uint32_t> cluster_of(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d& v = mesh.vertices[i];
    const auto place = [&](double x) {
      constexpr double kFarthest = 1e15;  // cells; whatever lies beyond is one
      return static_cast<std::int64_t>(std::clamp(std::floor(x / cell_m), -kFarthest, kFarthest));
    };
    const std::array<std::int64_t, 3> cell = {place(v.x()), place(v.y()), place(v.z())};
    const auto [entry, is_new] = numbers.emplace(cell, static_cast<std::uint32_t>(clusters.size()));
    if (is_new) clusters.emplace_back();
    cluster_of[i] = entry->second;
    Cluster& cluster = clusters[entry->second];
    cluster.position += v;
    if (!mesh.colors.empty())
      cluster.color += Vector3d(mesh.colors[i][0], mesh.colors[i][1], mesh.colors[i][2]);
    if (!mesh.quality.empty()) cluster.quality += static_cast<double>(mesh.quality[i]);
    if (!mesh.radii_m.empty()) {
      cluster.normal += mesh.normals[i].cast<double>();
      cluster.radius_m += static_cast<double>(mesh.radii_m[i]);
    }
    ++cluster.count;
  }
  PreciseMesh result;
  for (const Cluster& cluster : clusters) {
    result.vertices.push_back(cluster.position / cluster.count);
    const Vector3d color = cluster.color / cluster.count;
    const auto level = [&](int c) { return static_cast<std::uint8_t>(std::lround(color[c])); };
    if (!mesh.colors.empty()) result.colors.push_back({level(0), level(1), level(2)});
    if (!mesh.quality.empty()) result.quality.push_back(static_cast<float>(cluster.quality / cluster.count));
    if (!mesh.radii_m.empty()) add_disc(result, cluster, cell_m);
  }
  std::set<std::array<std::uint32_t, 3>> known;  // by sorted corners: either face of a thin sheet is enough
  for (const auto& [i, j, k] : mesh.triangles) {
    const std::array<std::uint32_t, 3> triangle = {cluster_of[i], cluster_of[j], cluster_of[k]};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    std::array<std::uint32_t, 3> key = triangle;
    std::ranges::sort(key);
    if (known.insert(key).second) result.triangles.push_back(triangle);
  }
  return result;
}

PreciseMesh reduced(const PreciseMesh& mesh, std::size_t most) {
  if (parts_of(mesh) <= most) return mesh;
  constexpr double kLargest_m = 1e4;
  PreciseMesh result;
  for (double cell_m = 0.005; cell_m < kLargest_m; cell_m *= std::sqrt(2.0)) {
    result = clustered(mesh, cell_m);
    if (parts_of(result) <= most) break;
  }
  return result;
}

}  // namespace fusebench::mesh_error
