// Absolute and relative errors of a trajectory against a reference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/metrics/trajectory_error/alignment.hpp"
#include "eval/metrics/trajectory_error/motion_pairs.hpp"
#include "eval/metrics/trajectory_error/pose_relation.hpp"
#include "eval/metrics/trajectory_error/streamed_statistics.hpp"
#include "eval/metrics/trajectory_files/trajectory_pair.hpp"

namespace fusebench::trajectory_error {

/// As many poses on either side, as they were compared: associated, the estimate aligned, both projected.
struct ComparedPoses {
  Trajectory reference;
  Trajectory estimate;
};

/// What was compared, and how: everything that two numbers must share before they are compared themselves.
struct TrajectoryError {
  PoseRelation relation = PoseRelation::translation;
  std::size_t pairs = 0;     ///< associated poses
  std::size_t possible = 0;  ///< poses that could have been
  double coverage = 0;       ///< pairs / possible
  AlignmentMode alignment_mode = AlignmentMode::none;
  Similarity alignment;             ///< reference from estimate
  std::vector<double> errors;       ///< in the relation's unit
  std::vector<std::int64_t> at_ns;  ///< of each error, the estimate's stamp (of a motion: of its end)
  /// Where poses are kept: of each error, its pose among the compared (of a motion: its end).
  std::vector<std::size_t> at;
  ComparedPoses compared;  ///< empty unless they are kept
  /// Of more motions than are listed, the errors one by one; `errors`, `at_ns` and `at` are then empty.
  ValueSource streamed;
  metrics::Statistics stats;
};

/// A plane that both are projected onto before they are compared, after the alignment.
enum class Plane { none, xy, xz, yz };
[[nodiscard]] std::string_view to_string(Plane plane);  ///< "none", "xy", "xz", "yz"

struct AbsoluteOptions {
  PoseRelation relation = PoseRelation::translation;
  AlignmentRequest alignment;
  Plane plane = Plane::none;
  bool keep_poses = false;
};

/// What moves the estimate of a pair. Errors as align().
[[nodiscard]] Result<Similarity> align(const trajectory_files::TrajectoryPair& pair,
                                       const AlignmentRequest& request);

/// Error of each associated pose. Errors: configuration for a relation of motions, data_corrupt as align().
[[nodiscard]] Result<TrajectoryError> absolute_error(const trajectory_files::TrajectoryPair& pair,
                                                     const AbsoluteOptions& options);

enum class MotionSelection { consecutive, all };

struct RelativeOptions {
  PoseRelation relation = PoseRelation::translation;
  AlignmentRequest alignment;  ///< a scale changes motions, a rigid alignment does not
  Plane plane = Plane::none;
  Delta delta;
  MotionSelection selection = MotionSelection::consecutive;
  double tolerance = 0.1;       ///< of delta, where all motions are taken
  bool from_reference = false;  ///< the reference's motions decide which are taken
  MotionListing listing = {};
  bool keep_poses = false;
};

/// Error of motions over a delta, selected from the associated poses. Errors: configuration for a delta that
/// makes no sense, data_corrupt if no motion is left.
[[nodiscard]] Result<TrajectoryError> relative_error(const trajectory_files::TrajectoryPair& pair,
                                                     const RelativeOptions& options);

/// The same over given motions.
[[nodiscard]] Result<TrajectoryError> relative_error(const trajectory_files::TrajectoryPair& pair,
                                                     const RelativeOptions& options,
                                                     const IndexPairs& motions);

/// Every k-th pose so that `count` remain, both ends among them (evo's --downsample); fewer are left as they
/// are.
[[nodiscard]] Trajectory downsampled(const Trajectory& trajectory, std::size_t count);

/// Poses that moved by a path of distance_m or turned by angle_rad since the last kept one (evo's
/// --motion_filter).
[[nodiscard]] Trajectory moved_only(const Trajectory& trajectory, double distance_m, double angle_rad);

}  // namespace fusebench::trajectory_error
