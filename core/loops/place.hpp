// What loops are closed between, and the pairs that were looked at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/types.hpp"
#include "core/places/place_verification.hpp"

namespace fusebench::loops {

/// A fused frame that can be recognised when the camera comes back to it.
struct Place {
  std::int64_t timestamp_ns = 0;  ///< of the frame
  SE3 T_world_camera;             ///< when it was fused, in the world of the odometry
  /// Of that pose in the world of the first camera, in its tangent (rotation on the right, world position).
  Matrix6d covariance = Matrix6d::Zero();
  /// What dead reckoning added to it in the times that the tracker was lost before.
  Matrix6d lost_covariance = Matrix6d::Zero();
  std::optional<Vector3d> gravity_camera;  ///< unit; with an IMU
  double view_depth_m = 0;                 ///< median of its depth
  double blur_px = 0;
  Vector3d angular_velocity_camera_radps = Vector3d::Zero();
  Vector3d velocity_camera_mps = Vector3d::Zero();  ///< of the camera, against the world
  std::size_t relocalisations = 0;                  ///< before it
  places::Appearance appearance;
};

/// What a pair is believed by.
enum class LoopEvidence {
  pair,              ///< its images and depth
  pair_and_tracker,  ///< and a lost tracker found itself by it, which is support enough
  tracker_alone,     ///< images and depth of the pair itself could not be verified
};

/// A pair of places that was looked at.
struct LoopCandidate {
  std::size_t known = 0;  ///< places, by index
  std::size_t query = 0;
  double dissimilarity = 0;
  places::VerifiedPair pair;
  double chi2 = 0;  ///< squared distance to the poses so far, by drift and the edge's own error
  bool accepted = false;
  std::string verdict;  ///< why it was taken or refused
  LoopEvidence evidence = LoopEvidence::pair;

  [[nodiscard]] bool by_tracker() const { return evidence != LoopEvidence::pair; }
};

}  // namespace fusebench::loops
