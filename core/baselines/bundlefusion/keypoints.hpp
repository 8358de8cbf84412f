// Keypoints of a frame as 3D points: SIFT (Lowe 2004) by OpenCV, with depth.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::baselines::bundlefusion {

/// Integers from 0 to 255, so that products of descriptors are exact in any order of summation.
struct SiftDescriptor {
  std::array<std::int16_t, 128> values{};
  double inverse_norm = 0;
};

struct Keypoint {
  Vector2d pixel_px = Vector2d::Zero();
  Vector3d point_camera = Vector3d::Zero();  ///< metres
  SiftDescriptor descriptor;
};
using Keypoints = std::vector<Keypoint>;

/// The strongest keypoints, at most max_count, in the order of their strength: scale (standard deviation of
/// the Gaussian) of at least min_scale_px, at pixels with depth (> 0; same size as the grey image). Dai et
/// al. 2017, Sec. 4.1. Errors: none; an image without texture has no keypoints.
[[nodiscard]] Keypoints find_keypoints(const GreyImage& grey, const DepthImage& depth_m,
                                       const PinholeCamera& camera, int max_count, double min_scale_px);

}  // namespace fusebench::baselines::bundlefusion
