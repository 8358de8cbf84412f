#include "core/baselines/elasticfusion/surfels/surfel_cloud.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

Mesh surfel_cloud(const SurfelMap& map, float min_confidence) {
  Mesh cloud;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map.confidence[i] <= min_confidence) continue;
    cloud.vertices.push_back(map.position[i]);
    cloud.normals.push_back(map.normal[i]);
    cloud.colors.push_back(map.color[i]);
    cloud.radii_m.push_back(map.radius_m[i]);
  }
  return cloud;
}

}  // namespace fusebench::baselines::elasticfusion::surfels
