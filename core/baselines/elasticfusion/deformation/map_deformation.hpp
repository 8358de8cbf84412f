// Builds a deformation graph from the surfels of a map, and deforms the map.
#pragma once

#include <optional>

#include "core/base/parallel.hpp"
#include "core/baselines/elasticfusion/deformation/deformation_graph.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_map.hpp"

namespace fusebench::baselines::elasticfusion::deformation {

/// A node for every spacing-th surfel by age, scaled to images of 640x480. Nothing if there are too few
/// surfels.
[[nodiscard]] std::optional<DeformationGraph> graph_of(const surfels::SurfelMap& map,
                                                       const PinholeCamera& camera, std::size_t spacing);

/// Deforms all surfels, each by its position and creation time.
void deform(const DeformationGraph& graph, const Workers& workers, surfels::SurfelMap& map);

}  // namespace fusebench::baselines::elasticfusion::deformation
