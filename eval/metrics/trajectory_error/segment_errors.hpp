// Relative errors over segments of given lengths, as benchmarks of odometry report them:
// rpg_trajectory_evaluation (Zhang & Scaramuzza, IROS 2018), KITTI (Geiger et al., CVPR 2012) and ETH3D
// (Schoeps et al., CVPR 2019).
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/trajectory_error/motion_pairs.hpp"
#include "eval/metrics/trajectory_files/trajectory_pair.hpp"

namespace fusebench::trajectory_error {

/// Errors of the segments of one length, each list as long as there are segments. Angles in radians.
struct SegmentErrors {
  double length_m = 0;
  std::vector<double> path_m;  ///< of the reference over each segment, about length_m
  std::vector<double> translation_m;
  std::vector<double> rotation_rad;
  std::vector<double> yaw_rad;      ///< about the world's z at the segment's end
  std::vector<double> gravity_rad;  ///< roll and pitch together
};

/// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), the estimate's motion scaled, with E turned into the world of the
/// estimate at the segment's end to part yaw from tilt (Euler angles z, y, x).
[[nodiscard]] SegmentErrors segment_errors(const trajectory_files::TrajectoryPair& pair,
                                           const IndexPairs& segments, double length_m, double scale = 1);

/// 10, 20, 30, 40 and 50 % of the reference's path (all of its poses), cut to centimetres.
[[nodiscard]] std::vector<double> rpg_lengths(const Trajectory& reference);

/// KITTI's segments: from every tenth pose to the first that lies further along the reference by `length_m`.
[[nodiscard]] IndexPairs kitti_segments(const Trajectory& reference, double length_m);

/// ETH3D's segments: from every pose to the one whose path is nearest to length_m further along the
/// reference, if it is off by at most 2.5 cm; they end before the last pose.
[[nodiscard]] IndexPairs eth3d_segments(const Trajectory& reference, double length_m);

}  // namespace fusebench::trajectory_error
