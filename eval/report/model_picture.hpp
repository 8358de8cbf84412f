// A model with the path of its camera as one picture: for paper, browsers without WebGL, and slides.
#pragma once

#include <span>
#include <vector>

#include "core/base/image.hpp"
#include "core/base/types.hpp"

namespace fusebench::report {

/// 800 px wide, as high as the model needs (400 to 720 px): the model (model_view(), at twice the
/// resolution) from behind and above its camera at an angle, and over it the camera path with a dot at its
/// start. mesh: triangles; poses: T_mesh_camera over time, at least one; path: colour of the path.
[[nodiscard]] ColorImage model_picture(const PreciseMesh& mesh, std::span<const SE3> poses, const Rgb& path);

}  // namespace fusebench::report
