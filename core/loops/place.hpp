// A fused frame that can be recognised when the camera comes back to it.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/types.hpp"
#include "core/config/config.hpp"
#include "core/ferns/fern_code.hpp"
#include "core/relocalisation/keyframes.hpp"

namespace fusebench::loops {

struct Place {
  std::int64_t timestamp_ns = 0;  ///< of the frame
  SE3 T_world_camera;             ///< when it was fused, in the world of the odometry
  /// Of that pose in the world of the first camera, in its tangent (rotation on the right, world position).
  Matrix6d covariance = Matrix6d::Zero();
  std::optional<Vector3d> gravity_camera;  ///< unit; with an IMU
  double blur_px = 0;
  double angular_speed_radps = 0;
  double speed_mps = 0;
  ferns::FernCode code{};
  relocalisation::Landmarks landmarks;
  DepthImage small_depth_m;  ///< every fourth pixel
  GreyImage small_grey;      ///< means of 4x4 pixels
};

/// Of small_depth_m and small_grey.
inline constexpr int kDepthStep = 4;

/// What the images tell: all but the pose and its motion.
[[nodiscard]] Place place_of(const RgbdFrame& frame, const PinholeCamera& camera,
                             const config::Config& config);

}  // namespace fusebench::loops
