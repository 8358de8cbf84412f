// A mesh with fewer triangles, to be checked.
#pragma once

#include <cstddef>

#include "core/base/types.hpp"

namespace fusebench::mesh_error {

/// Merges the vertices within each cell of a grid into their mean (positions, colours and quality; normals
/// are dropped, but those of surfels, which then cover their cell) and drops the triangles that fold up
/// (after Rossignac and Borrel, "Multi-resolution 3D approximations", 1993). cell_m above 0.
[[nodiscard]] PreciseMesh clustered(const PreciseMesh& mesh, double cell_m);

/// With the smallest cell, of those that grow from 5 mm by the root of 2, that leaves at most so many
/// triangles or surfels; the mesh itself if it has no more.
[[nodiscard]] PreciseMesh reduced(const PreciseMesh& mesh, std::size_t most);

}  // namespace fusebench::mesh_error
