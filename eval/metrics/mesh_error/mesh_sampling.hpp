// Points of a surface, to be measured.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::mesh_error {

/// Which points of a surface are measured.
enum class MeshSamples {
  vertices,  ///< those of the surface, so a finely meshed part counts more
  area,      ///< spread evenly over the area by a seed
};
[[nodiscard]] std::string_view to_string(MeshSamples samples);  ///< "vertices", "area"

struct MeshSampling {
  MeshSamples from = MeshSamples::area;
  std::size_t count = 50'000;  ///< of area
  std::uint64_t seed = 1;      ///< of area
};

/// Error data_corrupt if the mesh has neither triangles nor surfels, a triangle with a vertex that does not
/// exist, or a vertex beyond trajectory::kMostPosition. `what` names the mesh.
[[nodiscard]] Result<void> check_mesh(const PreciseMesh& mesh, std::string_view what);

/// Vertices of the surface of a mesh that check_mesh accepts: the centres of its surfels, or the vertices
/// that its triangles name. A vertex that no triangle names belongs to no surface.
[[nodiscard]] std::vector<Vector3d> surface_vertices(const PreciseMesh& mesh);

/// Samples of a mesh that check_mesh accepts. Of vertices: all of the file, as CloudCompare and
/// SurfReg take them. Of area: one in each of
/// `count` parts of equal area, by the order of the triangles (of surfels: with_discs()). Error data_corrupt:
/// a mesh without area.
[[nodiscard]] Result<std::vector<Vector3d>> sample_mesh(const PreciseMesh& mesh,
                                                        const MeshSampling& sampling);

}  // namespace fusebench::mesh_error
