// Intensities of a frame against those of the frame before, for the tracker that uses both.
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/systems/pose_sums.hpp"

namespace fusebench::systems::infinitam {

struct ColorMatching {
  double tukey = 0;           ///< width of Tukey's norm (intensities from 0 to 1)
  double max_difference = 0;  ///< of a match
  double min_gradient = 0;    ///< in x and in y (intensity per pixel)
  double near_m = 0;          ///< weights fall from 1 here to 0 at far_m, as the square of what is left
  double far_m = 0;           ///< pixels beyond are not used
};

/// One level of both frames.
struct ColorLevel {
  const DepthImage* depth_m = nullptr;      ///< of the frame
  const Image<float>* intensity = nullptr;  ///< of the frame, registered with its depth
  const Image<float>* before = nullptr;     ///< of the frame before
  const Image<float>* before_dx = nullptr;  ///< its gradient (Sobel, per pixel)
  const Image<float>* before_dy = nullptr;
  PinholeCamera camera;
};

/// Sums over all pixels of a level: each is moved into the world and seen from the camera of the frame
/// before.
[[nodiscard]] PoseSums match_color(const ColorLevel& level, const SE3& T_world_camera,
                                   const SE3& T_world_before, const ColorMatching& matching,
                                   const Workers& workers);

}  // namespace fusebench::systems::infinitam
