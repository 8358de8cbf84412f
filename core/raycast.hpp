// Rays against the model: depth and surface normal as a camera at a given pose would see them.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "core/surface_point.hpp"
#include "core/tsdf_lanes.hpp"
#include "core/tsdf_volume.hpp"
#include "core/types.hpp"

namespace fusebench {

/// The first zero crossing from front to back between depth.min_m and depth.max_m along the ray of a pixel,
/// by steps of the field's own size, refined to the crossing of the trilinear field; invalid where the ray
/// meets no observed surface, crosses from behind, or the normal cannot be computed. Single precision: depth
/// is good to a thousandth of a voxel.
[[nodiscard]] SurfacePoint raycast_pixel(const TsdfVolume& volume, const PinholeCamera& camera,
                                         const SE3& T_world_camera, double u_px, double v_px,
                                         const DepthConfig& depth);

/// A pixel, and the part of its ray that is asked for (z-depth, metres; depth.min_m and max_m hold as well).
struct PixelRay {
  double u_px = 0;
  double v_px = 0;
  float begin_m = 0;
  float end_m = std::numeric_limits<float>::infinity();
};

/// raycast_pixel for a list of pixels, in parallel; results in the order of the pixels, in memory that is
/// used again. Neighbours in the list should be neighbours in the image.
void raycast_pixels(const TsdfVolume& volume, const PinholeCamera& camera, const SE3& T_world_camera,
                    std::span<const PixelRay> pixels, const DepthConfig& depth, const Workers& workers,
                    std::vector<SurfacePoint>& points);
/// The same in a field that is already in view of the camera (field_in_view).
void raycast_pixels(const TsdfLanes& field, const PinholeCamera& camera, const SE3& T_world_camera,
                    std::span<const PixelRay> pixels, const DepthConfig& depth, const Workers& workers,
                    std::vector<SurfacePoint>& points);

/// Depth (0 = none) and normals (zero = none) of the whole image.
struct SurfaceImage {
  DepthImage depth_m;
  Image<Eigen::Vector3f> normal_world;
};
[[nodiscard]] SurfaceImage raycast_image(const TsdfVolume& volume, const PinholeCamera& camera,
                                         const SE3& T_world_camera, const DepthConfig& depth,
                                         const Workers& workers);

}  // namespace fusebench
