// The mesh of another system.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::external {

/// A mesh or a cloud of points in metres (PLY or OBJ, of which a unit is unit_m), without what it says of its
/// own quality: the error of each vertex is ours. Errors: those of mesh::read_mesh().
[[nodiscard]] Result<Mesh> read_foreign_mesh(const std::filesystem::path& file, double unit_m = 1);

}  // namespace fusebench::external
