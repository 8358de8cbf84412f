#include "core/baselines/elasticfusion/deformation/map_deformation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <vector>

namespace fusebench::baselines::elasticfusion::deformation {

namespace {

constexpr std::size_t kSurfelsAtOnce = 4096;
constexpr std::size_t kPixels = 640 * 480;

}  // namespace

std::optional<DeformationGraph> graph_of(const surfels::SurfelMap& map, const PinholeCamera& camera,
                                         std::size_t spacing) {
  const auto pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  const std::size_t step = std::max<std::size_t>(1, spacing * pixels / kPixels);
  std::vector<TimedPoint> nodes;
  for (std::size_t i = 0; i < map.size(); i += step)
    nodes.push_back({map.position[i].cast<double>(), map.created[i]});
  return DeformationGraph::make(nodes);
}

void deform(const DeformationGraph& graph, const Workers& workers, surfels::SurfelMap& map) {
  workers.for_chunks(map.size(), kSurfelsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const TimedPoint point{map.position[i].cast<double>(), map.created[i]};
      const auto influence = graph.influence_of(point);
      map.position[i] = graph.moved(point.position, influence).cast<float>();
      // Inverse transpose, so that normals stay orthogonal to the deformed surface.
      const Vector3d normal = graph.linear(influence).inverse().transpose() * map.normal[i].cast<double>();
      if (normal.allFinite() && normal.norm() > 0) map.normal[i] = normal.normalized().cast<float>();
    }
  });
}

}  // namespace fusebench::baselines::elasticfusion::deformation
