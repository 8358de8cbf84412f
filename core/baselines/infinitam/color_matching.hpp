// Registration of the intensities of a frame with those of the previous frame, for the extended tracker.
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/baselines/pose_sums.hpp"

namespace fusebench::baselines::infinitam {

struct ColorMatching {
  double tukey = 0;           ///< width of Tukey's norm (intensities from 0 to 1)
  double max_difference = 0;  ///< limit of a match
  double min_gradient = 0;    ///< in both x and y (intensity per pixel)
  double near_m = 0;          ///< weight: 1 at near_m, decreasing quadratically to 0 at far_m
  double far_m = 0;           ///< farther pixels are not used
};

/// One level of both frames.
struct ColorLevel {
  const DepthImage* depth_m = nullptr;      ///< of the frame
  const Image<float>* intensity = nullptr;  ///< of the frame, registered with its depth
  const Image<float>* before = nullptr;     ///< of the previous frame
  const Image<float>* before_dx = nullptr;  ///< gradient of `before` (Sobel, per pixel)
  const Image<float>* before_dy = nullptr;
  PinholeCamera camera;
};

/// Sums over all pixels of a level: each is transformed to the world and projected into the camera of the
/// previous frame.
[[nodiscard]] PoseSums match_color(const ColorLevel& level, const SE3& T_world_camera,
                                   const SE3& T_world_before, const ColorMatching& matching,
                                   const Workers& workers);

}  // namespace fusebench::baselines::infinitam
