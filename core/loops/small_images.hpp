// Pixels of the small images of a place, and points in its camera.
#pragma once

#include <cmath>
#include <optional>

#include "core/base/types.hpp"
#include "core/loops/place.hpp"

namespace fusebench::loops {

/// The point at the depth of a pixel of small_depth_m, in the camera's axes (metres).
[[nodiscard]] inline Vector3d point_at(const DepthImage& small_depth_m, int x, int y,
                                       const PinholeCamera& camera) {
  return camera.back_project(kDepthStep * x, kDepthStep * y, static_cast<double>(small_depth_m(x, y)));
}

struct SmallPixel {
  int x = 0, y = 0;
};

/// Where a point in the camera's axes is seen in an image of the size of small_depth_m; nothing if it is not.
template <class Pixel>
[[nodiscard]] std::optional<SmallPixel> pixel_of(const Vector3d& point_camera, const PinholeCamera& camera,
                                                 const Image<Pixel>& image) {
  if (point_camera.z() <= 0) return std::nullopt;
  const Vector2d pixel = camera.project(point_camera) / kDepthStep;
  // A point near the plane of the camera projects beyond any integer.
  if (!(pixel.cwiseAbs().maxCoeff() < image.width + image.height)) return std::nullopt;
  const SmallPixel seen{static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))};
  return image.contains(seen.x, seen.y) ? std::optional(seen) : std::nullopt;
}

}  // namespace fusebench::loops
