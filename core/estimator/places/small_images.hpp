// Depth and intensities of a frame at a quarter of its size. Comparisons at this size are insensitive to
// motion blur and missing texture.
#pragma once

#include <cmath>
#include <optional>

#include "core/base/types.hpp"

namespace fusebench::places {

inline constexpr int kSmallStep = 4;  ///< pixels of the frame for each small pixel, in both directions

struct SmallImages {
  DepthImage depth_m;  ///< every fourth pixel
  GreyImage grey;      ///< means of 4x4 pixels
};

[[nodiscard]] SmallImages small_images_of(const GreyImage& grey, const DepthImage& depth_m);

/// The point at the depth of a small pixel, camera axes (metres).
[[nodiscard]] inline Vector3d point_at(const DepthImage& small_depth_m, int x, int y,
                                       const PinholeCamera& camera) {
  return camera.back_project(kSmallStep * x, kSmallStep * y, static_cast<double>(small_depth_m(x, y)));
}

struct SmallPixel {
  int x = 0, y = 0;
};

/// Projection of a point (camera axes) to an image of the small size; nothing if it is outside.
template <class Pixel>
[[nodiscard]] std::optional<SmallPixel> pixel_of(const Vector3d& point_camera, const PinholeCamera& camera,
                                                 const Image<Pixel>& image) {
  if (point_camera.z() <= 0) return std::nullopt;
  const Vector2d pixel = camera.project(point_camera) / kSmallStep;
  // A point near the plane of the camera projects beyond the range of integers.
  if (!(pixel.cwiseAbs().maxCoeff() < image.width + image.height)) return std::nullopt;
  const SmallPixel seen{static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))};
  return image.contains(seen.x, seen.y) ? std::optional(seen) : std::nullopt;
}

}  // namespace fusebench::places
