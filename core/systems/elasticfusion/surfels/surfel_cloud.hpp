// Surfels as a surface that can be measured, drawn and written.
#pragma once

#include "core/systems/elasticfusion/surfels/surfel_map.hpp"

namespace fusebench::systems::elasticfusion::surfels {

/// Surfels of more than this confidence as points with normals, colours and radii.
[[nodiscard]] Mesh surfel_cloud(const SurfelMap& map, float min_confidence);

}  // namespace fusebench::systems::elasticfusion::surfels
