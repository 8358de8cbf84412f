// Triangle mesh of the zero level of the field (Lorensen & Cline 1987).
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::meshing {

/// Extracts an indexed mesh in the world frame. Each lattice edge that crosses the surface has exactly one
/// vertex, with the unit gradient as its normal and with a colour (black if none was observed there; no
/// colours at all if no frame had any). Triangles are counter-clockwise seen from free space. Cells with an
/// unobserved voxel or a weight below min_weight are left open. The order of vertices and triangles depends
/// on the field only (blocks sorted by index), not on storage or threads.
[[nodiscard]] Mesh extract_mesh(const tsdf::TsdfVolume& volume, double min_weight, const Workers& workers);

}  // namespace fusebench::meshing
