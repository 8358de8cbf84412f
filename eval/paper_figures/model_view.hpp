// A reconstruction as a picture from a given camera, so that several can be compared in one view.
#pragma once

#include "core/base/image.hpp"
#include "core/base/types.hpp"

namespace fusebench::paper_figures {

/// Nearest surface that is seen from its front: from outside, walls of a room that face away are looked
/// through. Colours are the mesh's (grey without), shaded by the angle to the ray; where there is nothing the
/// image is white. T_mesh_camera: of the view's camera.
[[nodiscard]] ColorImage model_view(const Mesh& mesh, const PinholeCamera& camera, const SE3& T_mesh_camera);

}  // namespace fusebench::paper_figures
