// What the pixels of a camera see at one instant of each row.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "datasets/simulator/rays/ray_field.hpp"

namespace fusebench::simulator::render {

/// Where the rays of an image start: one pose for each row, so that a rolling shutter is a list of poses.
/// Rows share a pose if the list has one entry.
struct RowPoses {
  std::vector<SE3> T_world_camera;

  [[nodiscard]] const SE3& of_row(int row) const {
    return T_world_camera.size() == 1 ? T_world_camera.front()
                                      : T_world_camera[static_cast<std::size_t>(row)];
  }
};

/// By pixel, for rays through the middle of the pixels. Rays from nearby poses mostly meet the same
/// triangles, which then need not be searched for.
struct VisibleTriangles {
  static constexpr std::int32_t kEdge = -1;

  RowPoses poses;
  Image<std::int32_t> triangle;  ///< -1: nothing
  /// The face of the triangle (TrianglePlanes), or kEdge where a pixel of the 3 x 3 around it sees another
  /// face, nothing, or a jump of depth. Only pixels at an edge may have another surface before them nearby.
  Image<std::int32_t> face;
  Image<float> inverse_depth_per_m;  ///< 0: nothing
  /// The greatest of it within a distance in rows and columns (find_nearest_around()): of what may be before
  /// the pixel from other poses.
  Image<float> nearest_inverse_depth_per_m;
};

/// Fills in `face`, from the triangles and their depth. faces: by triangle.
void mark_edges(const std::int32_t* faces, VisibleTriangles& visible);

/// Fills in what is nearest within so many pixels: those that it moves by to other poses.
void find_nearest_around(int distance_px, VisibleTriangles& visible);

/// The longest way in pixels that what the pixels see takes in the image while the camera moves from `begin`
/// to `end` (poses of the rows), over every 16th pixel in either direction.
[[nodiscard]] double longest_image_motion_px(const VisibleTriangles& visible, const rays::RayField& rays,
                                             const RowPoses& begin, const RowPoses& end);

}  // namespace fusebench::simulator::render
