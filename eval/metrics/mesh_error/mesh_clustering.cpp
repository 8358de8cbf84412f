#include "eval/metrics/mesh_error/mesh_clustering.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
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

/// Of three numbers: mixes the bits of each into those of the others.
struct NumbersHash {
  template <class Number>
  std::size_t operator()(const std::array<Number, 3>& numbers) const {
    std::uint64_t hash = 0;
    for (const Number number : numbers) {
      hash = (hash ^ static_cast<std::uint64_t>(number)) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 29U;
    }
    return static_cast<std::size_t>(hash);
  }
};

/// The vertices of a mesh in the cells of a grid, each cell with a number from when it was first met.
class Grid {
 public:
  Grid(const PreciseMesh& mesh, double cell_m)
      : mesh_(mesh), cell_m_(cell_m), cluster_of_(mesh.vertices.size(), kNoCluster) {}

  std::uint32_t cluster_of(std::size_t vertex) {
    std::uint32_t& cluster = cluster_of_[vertex];
    if (cluster != kNoCluster) return cluster;
    const Vector3d& v = mesh_.vertices[vertex];
    const std::array<std::int64_t, 3> cell = {place(v.x()), place(v.y()), place(v.z())};
    cluster = numbers_.try_emplace(cell, static_cast<std::uint32_t>(numbers_.size())).first->second;
    return cluster;
  }
  /// Whether a triangle is met for the first time, by its corners: either face of a thin sheet is enough.
  bool is_new(std::array<std::uint32_t, 3> clusters) {
    std::ranges::sort(clusters);
    return triangles_.insert(clusters).second;
  }
  [[nodiscard]] std::size_t clusters() const { return numbers_.size(); }

 private:
  static constexpr std::uint32_t kNoCluster = std::numeric_limits<std::uint32_t>::max();

  [[nodiscard]] std::int64_t place(double x) const {
    constexpr double kFarthest = 1e15;  // cells; whatever lies beyond is one
    return static_cast<std::int64_t>(std::clamp(std::floor(x / cell_m_), -kFarthest, kFarthest));
  }

  const PreciseMesh& mesh_;
  double cell_m_;
  std::vector<std::uint32_t> cluster_of_;
  std::unordered_map<std::array<std::int64_t, 3>, std::uint32_t, NumbersHash> numbers_;
  std::unordered_set<std::array<std::uint32_t, 3>, NumbersHash> triangles_;
};

/// The triangles that do not fold up; nothing if there are more than `most`, found out as soon as there are.
std::optional<std::vector<std::array<std::uint32_t, 3>>> clustered_triangles(const PreciseMesh& mesh,
                                                                             Grid& grid, std::size_t most) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& [i, j, k] : mesh.triangles) {
    const std::array<std::uint32_t, 3> triangle = {grid.cluster_of(i), grid.cluster_of(j),
                                                   grid.cluster_of(k)};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    if (!grid.is_new(triangle)) continue;
    if (triangles.size() == most) return std::nullopt;
    triangles.push_back(triangle);
  }
  return triangles;
}

/// Mean positions and what else the vertices of a mesh have.
PreciseMesh merged_vertices(const PreciseMesh& mesh, Grid& grid, double cell_m) {
  std::vector<Cluster> clusters;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const std::uint32_t number = grid.cluster_of(i);
    clusters.resize(grid.clusters());
    Cluster& cluster = clusters[number];
    cluster.position += mesh.vertices[i];
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
  return result;
}

/// Whether the vertices are in at most so many cells.
bool has_at_most(const PreciseMesh& mesh, Grid& grid, std::size_t most) {
  for (std::size_t i = 0; i < mesh.vertices.size() && grid.clusters() <= most; ++i) grid.cluster_of(i);
  return grid.clusters() <= most;
}

/// Nothing if more than `most` triangles or surfels are left.
std::optional<PreciseMesh> clustered_to(const PreciseMesh& mesh, double cell_m, std::size_t most) {
  Grid grid(mesh, cell_m);
  if (!mesh.radii_m.empty() && !has_at_most(mesh, grid, most)) return std::nullopt;
  auto triangles = clustered_triangles(mesh, grid, most);
  if (!triangles) return std::nullopt;
  PreciseMesh result = merged_vertices(mesh, grid, cell_m);
  result.triangles = std::move(*triangles);
  return result;
}

}  // namespace

PreciseMesh clustered(const PreciseMesh& mesh, double cell_m) {
  check(cell_m > 0, "a cell has a size");
  return *clustered_to(mesh, cell_m, std::numeric_limits<std::size_t>::max());
}

PreciseMesh reduced(const PreciseMesh& mesh, std::size_t most) {
  if (parts_of(mesh) <= most) return mesh;
  constexpr double kLargest_m = 1e4;
  for (double cell_m = 0.005; cell_m < kLargest_m; cell_m *= std::sqrt(2.0))
    if (auto result = clustered_to(mesh, cell_m, most)) return std::move(*result);
  return clustered(mesh, kLargest_m);
}

}  // namespace fusebench::mesh_error
