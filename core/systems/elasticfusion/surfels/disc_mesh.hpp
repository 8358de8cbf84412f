// Surfels as a surface that can be measured, drawn and opened by any viewer.
#pragma once

#include "core/systems/elasticfusion/surfels/surfel_map.hpp"

namespace fusebench::systems::elasticfusion::surfels {

/// A triangle for each surfel of more than this confidence: equilateral, in the plane of the disc around its
/// middle, of the same area, with its normal and colour. Neighbours overlap as the discs do.
[[nodiscard]] Mesh disc_mesh(const SurfelMap& map, float min_confidence);

}  // namespace fusebench::systems::elasticfusion::surfels
