// Surfels, as triangles that can be measured and drawn.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::mesh_error {

/// A triangle in the place of each surfel: equilateral, of the area of its disc, in its plane, with the
/// surfel's normal, colour and quality at each corner. Neighbours overlap as the discs do. Any other mesh
/// stays as it is.
[[nodiscard]] PreciseMesh with_discs(PreciseMesh mesh);

}  // namespace fusebench::mesh_error
