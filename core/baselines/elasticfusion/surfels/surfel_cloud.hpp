// Converts surfels to a point cloud for metrics, images and files.
#pragma once

#include "core/baselines/elasticfusion/surfels/surfel_map.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

/// Surfels above this confidence as points with normals, colours and radii.
[[nodiscard]] Mesh surfel_cloud(const SurfelMap& map, float min_confidence);

}  // namespace fusebench::baselines::elasticfusion::surfels
