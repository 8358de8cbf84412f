// A reconstruction as a picture from a given camera, so that several can be compared in one view.
#pragma once

#include <span>

#include "core/base/image.hpp"
#include "core/base/types.hpp"

namespace fusebench::report {

/// Where points are on the plane z = 1 of a camera, without a share of strays (0 to 0.5) at each side. Points
/// behind the camera are left out; without any in front, -1 to 1.
[[nodiscard]] Eigen::AlignedBox2d seen_box(std::span<const Vector3d> points, const SE3& T_points_camera,
                                           double stray_share);

/// The camera in whose image the middle of the box is the middle, and the box is as large as fits with a
/// narrow margin.
[[nodiscard]] PinholeCamera camera_around(const Eigen::AlignedBox2d& box, int width_px, int height_px);

/// Nearest surface that is seen from its front: from outside, walls of a room that face away are looked
/// through. Colours are the mesh's (grey without), shaded by the angle to the ray; where there is nothing the
/// image is light grey. T_mesh_camera: of the view's camera.
[[nodiscard]] ColorImage model_view(Mesh mesh, const PinholeCamera& camera, const SE3& T_mesh_camera);

}  // namespace fusebench::report
