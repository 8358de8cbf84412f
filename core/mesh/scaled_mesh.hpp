// Meshes in other units than metres.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::mesh {

/// A mesh or surfels in metres, of one of which a unit is unit_m: vertices and radii are multiplied.
[[nodiscard]] PreciseMesh scaled(PreciseMesh mesh, double unit_m);

}  // namespace fusebench::mesh
