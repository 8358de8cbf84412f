// A fused frame that can be recognised when the camera comes back to it.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/types.hpp"
#include "core/loops/fern_code.hpp"
#include "core/relocalisation/keyframes.hpp"

namespace fusebench::loops {

struct Place {
  std::int64_t timestamp_ns = 0;  ///< of the frame
  SE3 T_world_camera;             ///< when it was fused
  /// Of that pose in the world of the first camera, in its tangent (rotation on the right, world position).
  Matrix6d covariance = Matrix6d::Zero();
  std::optional<Vector3d> gravity_camera;  ///< unit; with an IMU
  double blur_px = 0;
  FernCode code{};
  relocalisation::Landmarks landmarks;
  DepthImage small_depth_m;  ///< every fourth pixel
};

/// Of small_depth_m.
inline constexpr int kDepthStep = 4;

}  // namespace fusebench::loops
