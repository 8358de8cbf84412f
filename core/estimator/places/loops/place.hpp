// Places and candidate pairs of loop closure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/types.hpp"
#include "core/estimator/places/place_verification.hpp"

namespace fusebench::loops {

/// A fused frame that can be recognised when the camera comes back to it.
struct Place {
  std::int64_t timestamp_ns = 0;  ///< of the frame
  SE3 T_world_camera;             ///< when it was fused, in the odometry frame
  /// Covariance of that pose in the first camera frame, in its tangent (rotation on the right, world
  /// position).
  Matrix6d covariance = Matrix6d::Zero();
  /// Covariance that dead reckoning added in earlier losses.
  Matrix6d lost_covariance = Matrix6d::Zero();
  std::optional<Vector3d> gravity_camera;  ///< unit; with an IMU
  double view_depth_m = 0;                 ///< median depth of the frame
  double blur_px = 0;
  Vector3d angular_velocity_camera_radps = Vector3d::Zero();
  Vector3d velocity_camera_mps = Vector3d::Zero();  ///< relative to the world, camera axes
  std::size_t relocalisations = 0;                  ///< number of relocalisations before it
  places::Appearance appearance;
};

/// Evidence for a pair of places.
enum class LoopEvidence {
  pair,              ///< its images and depth
  pair_and_tracker,  ///< images, depth and a self-relocalisation, which together are sufficient
  tracker_alone,     ///< a self-relocalisation; images and depth could not be verified
};

/// A candidate pair of places.
struct LoopCandidate {
  std::size_t known = 0;  ///< indices of places
  std::size_t query = 0;
  double dissimilarity = 0;
  places::VerifiedPair pair;
  double chi2 = 0;  ///< squared distance to the current poses, by their drift and the error of the edge
  bool accepted = false;
  std::string verdict;  ///< reason for the acceptance or rejection
  LoopEvidence evidence = LoopEvidence::pair;

  [[nodiscard]] bool by_tracker() const { return evidence != LoopEvidence::pair; }
};

}  // namespace fusebench::loops
