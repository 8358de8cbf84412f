// Mesh files: PLY and Wavefront OBJ files.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::mesh {

/// Reads a mesh by the ending of its name, .ply or .obj (upper or lower case). Errors: usage for another
/// ending; those of read_ply() and read_obj().
[[nodiscard]] Result<PreciseMesh> read_mesh(const std::filesystem::path& file);

/// A mesh or surfels in metres, of one of which a unit is unit_m: vertices and radii are multiplied.
[[nodiscard]] PreciseMesh scaled(PreciseMesh mesh, double unit_m);

}  // namespace fusebench::mesh
