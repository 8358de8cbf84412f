#include "eval/metrics/mesh_error/surfel_discs.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace fusebench::mesh_error {

namespace {

/// From the middle to a corner of an equilateral triangle of the area of a disc of radius 1.
const double kCorner = std::sqrt(4 * std::numbers::pi / (3 * std::numbers::sqrt3));

}  // namespace

PreciseMesh with_discs(PreciseMesh mesh) {
  if (mesh.radii_m.empty()) return mesh;
  PreciseMesh discs;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d normal = mesh.normals[i].cast<double>();
    const Vector3d across = normal.unitOrthogonal(), up = normal.cross(across);
    const double reach_m = kCorner * static_cast<double>(mesh.radii_m[i]);
    const auto first = static_cast<std::uint32_t>(discs.vertices.size());
    for (int corner = 0; corner < 3; ++corner) {
      const double angle = 2 * std::numbers::pi / 3 * corner;
      discs.vertices.emplace_back(mesh.vertices[i] +
                                  reach_m * (std::cos(angle) * across + std::sin(angle) * up));
      discs.normals.push_back(mesh.normals[i]);
      if (!mesh.colors.empty()) discs.colors.push_back(mesh.colors[i]);
      if (!mesh.quality.empty()) discs.quality.push_back(mesh.quality[i]);
    }
    discs.triangles.push_back({first, first + 1, first + 2});
  }
  return discs;
}

}  // namespace fusebench::mesh_error
