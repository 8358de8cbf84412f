// Keypoints and depth without images, for the tests of what is done with them.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "core/baselines/bundlefusion/frame_pair.hpp"

namespace fusebench::testing {

/// Descriptors that differ from each other as those of different places do; the same for the same number.
inline baselines::bundlefusion::SiftDescriptor made_descriptor(std::size_t number) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(number) + 1);
  baselines::bundlefusion::SiftDescriptor descriptor;
  int squared_norm = 0;
  for (std::int16_t& value : descriptor.values) {
    // Few bins are large, as in real ones.
    value = static_cast<std::int16_t>(random() % 8 == 0 ? random() % 200 : random() % 4);
    squared_norm += int{value} * int{value};
  }
  descriptor.inverse_norm = 1.0 / std::sqrt(squared_norm);
  return descriptor;
}

/// A keypoint at a point in front of the camera.
inline baselines::bundlefusion::Keypoint made_keypoint(const PinholeCamera& camera,
                                                       const Vector3d& point_camera, std::size_t number) {
  return {camera.project(point_camera), point_camera, made_descriptor(number)};
}

inline PinholeCamera vga_camera() { return {640, 480, 525.0, 525.0, 319.5, 239.5}; }

/// The depth of a wall across the view.
inline baselines::bundlefusion::DepthCloud wall_cloud(double depth_m) {
  const PinholeCamera camera = vga_camera();
  return baselines::bundlefusion::make_depth_cloud(
      DepthImage(camera.width_px, camera.height_px, static_cast<float>(depth_m)), camera);
}

}  // namespace fusebench::testing
