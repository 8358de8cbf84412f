// Rays against the model: depth and surface normal as a camera at a given pose would see them.
#pragma once

#include <vector>

#include "core/parallel.hpp"
#include "core/tsdf_volume.hpp"
#include "core/types.hpp"

namespace fusebench {

/// The surface behind one pixel.
struct SurfacePoint {
  bool valid = false;
  double depth_m = 0;                        ///< z-depth in the camera frame
  Vector3d normal_world = Vector3d::Zero();  ///< unit, towards free space (gradient of the field)
};

/// The first zero crossing from front to back between depth.min_m and depth.max_m along the ray of a pixel,
/// by steps of the field's own size, refined to the crossing of the trilinear field; invalid where the ray
/// meets no observed surface, crosses from behind, or the normal cannot be computed.
[[nodiscard]] SurfacePoint raycast_pixel(const TsdfVolume& volume, const PinholeCamera& camera,
                                         const SE3& T_world_camera, double u_px, double v_px,
                                         const DepthConfig& depth);

/// raycast_pixel for a list of pixels, in parallel; results in the order of the pixels.
[[nodiscard]] std::vector<SurfacePoint> raycast_pixels(const TsdfVolume& volume, const PinholeCamera& camera,
                                                       const SE3& T_world_camera,
                                                       const std::vector<Vector2d>& pixels_px,
                                                       const DepthConfig& depth, const Workers& workers);

/// Depth (0 = none) and normals (zero = none) of the whole image.
struct SurfaceImage {
  DepthImage depth_m;
  Image<Eigen::Vector3f> normal_world;
};
[[nodiscard]] SurfaceImage raycast_image(const TsdfVolume& volume, const PinholeCamera& camera,
                                         const SE3& T_world_camera, const DepthConfig& depth,
                                         const Workers& workers);

}  // namespace fusebench
