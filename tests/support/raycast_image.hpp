// Rays against a whole model, and through a whole image.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/raycast/raycast.hpp"
#include "core/estimator/model/tsdf/tsdf_lanes.hpp"

namespace fusebench::testing {

/// raycast_pixels() in the field that the camera sees; nothing is met where it sees none.
inline void raycast_pixels(const tsdf::TsdfVolume& volume, const PinholeCamera& camera,
                           const SE3& T_world_camera, std::span<const raycast::PixelRay> pixels,
                           const config::DepthConfig& depth, const Workers& workers,
                           std::vector<raycast::SurfacePoint>& points) {
  const std::optional<tsdf::TsdfLanes> field = tsdf::field_in_view(volume, camera, T_world_camera, depth);
  if (field) {
    raycast::raycast_pixels(*field, camera, T_world_camera, pixels, depth, workers, points);
  } else {
    points.assign(pixels.size(), raycast::SurfacePoint{});
  }
}

inline raycast::SurfacePoint raycast_pixel(const tsdf::TsdfVolume& volume, const PinholeCamera& camera,
                                           const SE3& T_world_camera, double u_px, double v_px,
                                           const config::DepthConfig& depth) {
  std::vector<raycast::SurfacePoint> points;
  raycast_pixels(volume, camera, T_world_camera,
                 std::vector<raycast::PixelRay>{raycast::PixelRay{u_px, v_px}}, depth, Workers(1), points);
  return points[0];
}

/// A whole ray through each pixel of the image, row by row.
inline std::vector<raycast::PixelRay> image_rays(const PinholeCamera& camera) {
  std::vector<raycast::PixelRay> rays;
  rays.reserve(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x)
      rays.push_back({static_cast<double>(x), static_cast<double>(y)});
  }
  return rays;
}

/// Depth (0 = none) and normals (zero = none) of the whole image.
struct SurfaceImage {
  DepthImage depth_m;
  Image<Eigen::Vector3f> normal_world;
};
inline SurfaceImage raycast_image(const tsdf::TsdfVolume& volume, const PinholeCamera& camera,
                                  const SE3& T_world_camera, const config::DepthConfig& depth,
                                  const Workers& workers) {
  std::vector<raycast::SurfacePoint> points;
  raycast_pixels(volume, camera, T_world_camera, image_rays(camera), depth, workers, points);
  SurfaceImage image = {DepthImage(camera.width_px, camera.height_px),
                        Image<Eigen::Vector3f>(camera.width_px, camera.height_px, Eigen::Vector3f::Zero())};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].valid) continue;
    image.depth_m.data[i] = static_cast<float>(points[i].depth_m);
    image.normal_world.data[i] = points[i].normal_world.cast<float>();
  }
  return image;
}

}  // namespace fusebench::testing
