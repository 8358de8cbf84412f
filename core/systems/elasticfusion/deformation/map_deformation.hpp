// A deformation graph among the surfels of a map, and the map after it.
#pragma once

#include <optional>

#include "core/base/parallel.hpp"
#include "core/systems/elasticfusion/deformation/deformation_graph.hpp"
#include "core/systems/elasticfusion/surfels/surfel_map.hpp"

namespace fusebench::systems::elasticfusion::deformation {

/// Nodes at every so manieth surfel by age, of an image of 640x480: as many a frame for other sizes. Nothing
/// if there are too few surfels.
[[nodiscard]] std::optional<DeformationGraph> graph_of(const surfels::SurfelMap& map,
                                                       const PinholeCamera& camera, std::size_t spacing);

/// Moves all surfels, each by its place and the time it was created.
void deform(const DeformationGraph& graph, const Workers& workers, surfels::SurfelMap& map);

}  // namespace fusebench::systems::elasticfusion::deformation
