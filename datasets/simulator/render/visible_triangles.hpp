// Visible surfaces of a camera at one instant for each row.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "datasets/simulator/rays/ray_field.hpp"

namespace fusebench::simulator::render {

/// Camera poses for an image: one for each row, so that a rolling shutter is a list of poses. A list with one
/// entry applies to all rows.
struct RowPoses {
  std::vector<SE3> T_world_camera;

  [[nodiscard]] const SE3& of_row(int row) const {
    return T_world_camera.size() == 1 ? T_world_camera.front()
                                      : T_world_camera[static_cast<std::size_t>(row)];
  }
};

/// Triangles by pixel, for rays through the pixel centres. Rays from nearby poses mostly hit the same
/// triangles and need no search.
struct VisibleTriangles {
  static constexpr std::int32_t kEdge = -1;

  RowPoses poses;
  Image<std::int32_t> triangle;  ///< -1: no hit
  /// Face of the triangle (TrianglePlanes), or kEdge if a pixel of the 3 x 3 neighbourhood has another face,
  /// no hit, or a jump of depth. Only pixels at an edge can be occluded by another surface nearby.
  Image<std::int32_t> face;
  Image<float> inverse_depth_per_m;  ///< 0: no hit
  /// Maximum of inverse depth within a distance in rows and columns (find_nearest_around()): bound for
  /// occluders at other poses.
  Image<float> nearest_inverse_depth_per_m;
};

/// Sets `face` from the triangles and their depth. faces: by triangle.
void mark_edges(const std::int32_t* faces, VisibleTriangles& visible);

/// Sets nearest_inverse_depth_per_m for the given image motion.
void find_nearest_around(int distance_px, VisibleTriangles& visible);

/// Longest image motion in pixels of the visible points while the camera moves from `begin` to `end` (poses
/// of the rows), over every 16th pixel in both directions.
[[nodiscard]] double longest_image_motion_px(const VisibleTriangles& visible, const rays::RayField& rays,
                                             const RowPoses& begin, const RowPoses& end);

}  // namespace fusebench::simulator::render
