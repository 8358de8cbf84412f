// What the scripts that people compare trajectories with do, as data.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "eval/metrics/trajectory_error/alignment.hpp"
#include "eval/metrics/trajectory_error/motion_pairs.hpp"
#include "eval/metrics/trajectory_error/pose_relation.hpp"
#include "eval/metrics/trajectory_error/trajectory_error.hpp"
#include "eval/metrics/trajectory_files/trajectory_pair.hpp"

namespace fusebench::trajectory_error {

enum class Protocol {
  evo,    ///< evo v1.36.5
  tum,    ///< evaluate_ate.py and evaluate_rpe.py of the TUM RGB-D benchmark
  rpg,    ///< rpg_trajectory_evaluation
  eth3d,  ///< ETH3D's SLAM evaluation program
  kitti,  ///< the odometry benchmark; relative errors only
};
[[nodiscard]] std::string_view to_string(Protocol protocol);
/// Error usage for another name.
[[nodiscard]] Result<Protocol> parse_protocol(std::string_view text);
/// Where its definition comes from.
[[nodiscard]] std::string_view source_of(Protocol protocol);

enum class TrajectoryMetric { ate, rpe };
[[nodiscard]] std::string_view to_string(TrajectoryMetric metric);  ///< "ate", "rpe"

/// Which motions a relative error is taken over.
enum class MotionRule {
  consecutive,   ///< evo's default, see consecutive_motions()
  all,           ///< evo's --all_pairs, see all_motions()
  fixed_delta,   ///< TUM's --fixed_delta, see tum_motions()
  each_to_each,  ///< TUM without it, all pairs
  segments,      ///< of several lengths, as the protocol selects them
};
[[nodiscard]] std::string_view to_string(MotionRule rule);

/// Poses that moved or turned by so much since the last one that was kept (evo's --motion_filter).
struct MotionFilter {
  double distance_m = 0;
  double angle_rad = 0;
};

/// Everything that decides a number.
struct TrajectoryRequest {
  TrajectoryMetric metric = TrajectoryMetric::ate;
  Protocol protocol = Protocol::evo;
  std::size_t downsample = 0;  ///< poses that are left of each side before association; 0: all
  std::optional<MotionFilter> motion_filter;
  trajectory_files::AssociationOptions association;
  AlignmentRequest alignment;
  PoseRelation relation = PoseRelation::translation;
  Plane plane = Plane::none;
  MotionRule motions = MotionRule::consecutive;  ///< of a relative error, as all below
  Delta delta;
  double delta_tolerance = 0.1;
  bool from_reference = false;
  MotionListing listing = {};
  bool keep_poses = false;  ///< the evaluation keeps the poses as they were compared
  bool fit_offset = false;  ///< absolute errors: also with a fitted offset of the body, see fitted_offset()
};

/// What the protocol does if nothing else is requested. Error usage: it has no such metric.
[[nodiscard]] Result<TrajectoryRequest> request_for(Protocol protocol, TrajectoryMetric metric);

}  // namespace fusebench::trajectory_error
