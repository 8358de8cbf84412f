#include "eval/metrics/mesh_error/mesh_sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/trajectory/trajectory_rows.hpp"
#include "eval/metrics/mesh_error/surfel_discs.hpp"

namespace fusebench::mesh_error {

namespace {

/// In [0, 1), the same with any library.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

/// For each vertex whether it is a part of the surface.
std::vector<bool> on_surface(const PreciseMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), !mesh.radii_m.empty());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) used[vertex] = true;
  return used;
}

Result<std::vector<Vector3d>> area_samples(const PreciseMesh& mesh, const MeshSampling& sampling) {
  std::vector<Vector3d> points;
  std::vector<double> area_until;
  double area = 0;
  const auto corner = [&](std::size_t triangle, std::size_t which) -> Vector3d {
    return mesh.vertices[mesh.triangles[triangle][which]];
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    area += 0.5 * (corner(i, 1) - corner(i, 0)).cross(corner(i, 2) - corner(i, 0)).norm();
    area_until.push_back(area);
  }
  if (!(area > 0)) return fail(ErrorCode::data_corrupt, "the mesh has no area to take samples from");
  std::mt19937_64 random(sampling.seed);
  for (std::size_t i = 0; i < sampling.count; ++i) {
    const double at = area * (static_cast<double>(i) + uniform(random)) / static_cast<double>(sampling.count);
    const auto found = std::ranges::upper_bound(area_until, at);
    const auto triangle =
        std::min(static_cast<std::size_t>(found - area_until.begin()), mesh.triangles.size() - 1);
    const double root = std::sqrt(uniform(random));  // even within the triangle
    const double share = uniform(random);
    points.emplace_back((1 - root) * corner(triangle, 0) + root * (1 - share) * corner(triangle, 1) +
                        root * share * corner(triangle, 2));
  }
  return points;
}

}  // namespace

std::string_view to_string(MeshSamples samples) {
  return samples == MeshSamples::vertices ? "vertices" : "area";
}

Result<void> check_mesh(const PreciseMesh& mesh, std::string_view what) {
  if (mesh.triangles.empty() && mesh.radii_m.empty()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{} has no triangles ({} vertices)", what, mesh.vertices.size()),
                "distances are measured to surfaces, not to points; points with normals and a radius are "
                "accepted as surfels");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t largest = *std::ranges::max_element(mesh.triangles[i]);
    if (largest >= mesh.vertices.size()) {
      return fail(ErrorCode::data_corrupt, fmt::format("{}: triangle {} names vertex {} (there are {})", what,
                                                       i, largest, mesh.vertices.size()));
    }
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (const auto fault = trajectory::coordinate_fault("is at", mesh.vertices[i]))
      return fail(ErrorCode::data_corrupt, fmt::format("{}: vertex {} {}", what, i, *fault));
  }
  for (std::size_t i = 0; i < mesh.radii_m.size(); ++i) {
    const Eigen::Vector3f& n = mesh.normals[i];
    if (!(n.norm() > 0) || !n.allFinite() || !(mesh.radii_m[i] > 0))
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: surfel {} has normal {:g} {:g} {:g} and radius {:g} m", what, i, n.x(),
                              n.y(), n.z(), mesh.radii_m[i]),
                  "a surfel needs a normal other than 0 and a radius above 0: remove those without");
  }
  return {};
}

std::vector<Vector3d> surface_vertices(const PreciseMesh& mesh) {
  const std::vector<bool> used = on_surface(mesh);
  std::vector<Vector3d> points;
  points.reserve(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (used[i]) points.push_back(mesh.vertices[i]);
  return points;
}

Result<std::vector<Vector3d>> sample_mesh(const PreciseMesh& mesh, const MeshSampling& sampling) {
  if (sampling.from == MeshSamples::vertices) return mesh.vertices;
  return mesh.radii_m.empty() ? area_samples(mesh, sampling) : area_samples(with_discs(mesh), sampling);
}

}  // namespace fusebench::mesh_error
