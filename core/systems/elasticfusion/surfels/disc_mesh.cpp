#include "core/systems/elasticfusion/surfels/disc_mesh.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace fusebench::systems::elasticfusion::surfels {

namespace {

/// From the middle to a corner of an equilateral triangle of the area of a disc of radius 1.
const float kCorner = std::sqrt(4 * std::numbers::pi_v<float> / (3 * std::numbers::sqrt3_v<float>));

}  // namespace

Mesh disc_mesh(const SurfelMap& map, float min_confidence) {
  Mesh mesh;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map.confidence[i] <= min_confidence) continue;
    const Eigen::Vector3f& normal = map.normal[i];
    const Eigen::Vector3f across = normal.unitOrthogonal(), up = normal.cross(across);
    const float reach_m = kCorner * map.radius_m[i];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int corner = 0; corner < 3; ++corner) {
      const float angle = 2 * std::numbers::pi_v<float> / 3 * static_cast<float>(corner);
      mesh.vertices.emplace_back(map.position[i] +
                                 reach_m * (std::cos(angle) * across + std::sin(angle) * up));
      mesh.normals.push_back(normal);
      mesh.colors.push_back(map.color[i]);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

}  // namespace fusebench::systems::elasticfusion::surfels
