// Reader of Wavefront OBJ files.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::mesh {

/// Reads the vertices of a Wavefront OBJ file, with their colours if all have some, and its faces as
/// triangles; materials, normals and texture are left. Errors: data_missing; data_corrupt (names the line of
/// a bad vertex, or the shape of a face that names a vertex that does not exist).
[[nodiscard]] Result<PreciseMesh> read_obj(const std::filesystem::path& file);

}  // namespace fusebench::mesh
