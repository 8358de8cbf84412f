#include "datasets/simulator/render/triangle_planes.hpp"

#include <Eigen/Geometry>
#include <map>
#include <utility>

#include "core/base/disjoint_sets.hpp"

namespace fusebench::simulator::render {

namespace {

/// By triangle: a number common to triangles that are connected by vertices.
std::vector<std::int32_t> connected_triangles(const Mesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<std::int32_t> faces;
  faces.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) faces.push_back(static_cast<std::int32_t>(sets.root_of(t[0])));
  return faces;
}

}  // namespace

TrianglePlanes::TrianglePlanes(const Mesh& mesh, const std::vector<std::int32_t>& textures)
    : faces_(connected_triangles(mesh)) {
  planes_.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) planes_.push_back(plane_of(mesh, triangle));
  // Connected triangles of several textures: one face for each texture.
  if (textures.empty()) return;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> numbers;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const auto next = static_cast<std::int32_t>(numbers.size());
    faces_[i] = numbers.try_emplace({faces_[i], textures[i]}, next).first->second;
  }
}

TrianglePlanes::Plane TrianglePlanes::plane_of(const Mesh& mesh,
                                               const std::array<std::uint32_t, 3>& triangle) {
  const auto vertex = [&](std::size_t k) { return mesh.vertices[triangle[k]].cast<double>().eval(); };
  const Vector3d corner = vertex(0), to_second = vertex(1) - corner, to_third = vertex(2) - corner;
  const Vector3d normal = to_second.cross(to_third);
  const double squared = normal.squaredNorm();
  Plane plane;
  if (squared <= 0) return plane;
  plane.normal = normal.normalized().cast<float>();
  plane.along_u = (to_third.cross(normal) / squared).cast<float>();
  plane.along_v = (normal.cross(to_second) / squared).cast<float>();
  plane.corner = corner.cast<float>();
  return plane;
}

}  // namespace fusebench::simulator::render
