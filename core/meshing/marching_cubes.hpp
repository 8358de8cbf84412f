// Triangle mesh of the zero level of the field (Lorensen & Cline 1987).
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::meshing {

/// Indexed mesh in the world frame: each lattice edge that the surface crosses gives exactly one vertex, with
/// colour (no colours at all if no frame had any; black where only this place has none) and the unit gradient
/// as normal; triangles are counter-clockwise seen from free space. Cells with a voxel that was not observed,
/// or whose weight is below min_weight, are left open. Vertex and triangle order depend on the field alone
/// (blocks sorted by index), not on storage or threads.
[[nodiscard]] Mesh extract_mesh(const tsdf::TsdfVolume& volume, double min_weight, const Workers& workers);

}  // namespace fusebench::meshing
