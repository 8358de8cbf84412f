// Absolute and relative trajectory error, as the scripts of the TUM RGB-D benchmark define them
// (Sturm et al., IROS 2012). Ground truth is always found by time, never by position in the list.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/trajectory/association.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/metrics/trajectory_error/motion_pairs.hpp"
#include "eval/metrics/trajectory_error/streamed_statistics.hpp"

namespace fusebench::trajectory_error {

/// How the estimate was moved before it was compared.
struct Alignment {
  std::string mode = "none";  ///< "none" or "se3"
  SE3 T_reference_estimate;
};

/// Row-major 4x4 of a transform.
[[nodiscard]] std::array<double, 16> matrix_of(const SE3& transform);

struct AteOptions {
  double max_difference_s = 0.02;  ///< of associated stamps
  double offset_s = 0;             ///< added to the estimate's stamps
  /// Stamps at which an estimate was requested; those with ground truth are the possible pairs. Empty: the
  /// estimate's.
  std::span<const std::int64_t> expected_ns = {};
};

/// Absolute trajectory error: distance between associated positions after SE3 alignment of the estimate.
struct AteResult {
  std::string protocol = "tum";
  std::string relation = "translation";
  std::string unit = "m";
  std::size_t pairs = 0;
  std::size_t possible = 0;  ///< expected stamps with ground truth within the limit
  double coverage = 0;       ///< pairs / possible
  double max_difference_s = 0;
  Alignment alignment;
  std::vector<double> errors_m;  ///< in order of time
  metrics::Statistics stats;
};

/// The poses of both that belong together. Error data_corrupt: no stamps match.
[[nodiscard]] Result<std::vector<trajectory::AssociatedPair>> associated_poses(const Trajectory& ground_truth,
                                                                               const Trajectory& estimate,
                                                                               const AteOptions& options);

/// Errors data_corrupt: no matching stamps, or positions that cannot be aligned (see align_positions).
[[nodiscard]] Result<AteResult> absolute_trajectory_error(const Trajectory& ground_truth,
                                                          const Trajectory& estimate,
                                                          const AteOptions& options = {});

struct RpeOptions {
  double delta = 1;  ///< above 0, a whole number for frames
  DeltaUnit unit = DeltaUnit::seconds;
  bool all_pairs = false;  ///< every pose with every pose (--max_pairs 0 without --fixed_delta); no delta
  /// Ground truth further than this from an estimate's stamp is not used; TUM's own limit (twice the median
  /// interval of the ground truth) holds beside it.
  double max_difference_s = 0.02;
  double offset_s = 0;  ///< added to the estimate's stamps
  /// Not in the script, which chains over missing frames and, across a gap of the estimate longer than twice
  /// delta, pairs a pose with itself (error 0). With frames, a pair that spans more than 1.5 times `delta`
  /// median intervals of the estimate is skipped; a pose is never its own partner. False: as in the script.
  bool skip_gaps = true;
  bool skip_itself =
      false;  ///< with skip_gaps = false: a pose is not its own partner, the rest as in the script
  MotionListing listing = {};  ///< of all pairs
};

/// Relative pose error over a fixed delta (evaluate_rpe.py --fixed_delta).
///
/// For each pose i of the estimate, j is the pose whose index, stamp, path or summed angle is nearest to i's
/// plus delta; pairs that end at the last pose are dropped (so that the end is not counted over shorter
/// deltas; with frames and delta 1 this costs one pair, and is as in the script). Both poses take the nearest
/// ground truth. The error is E = (P_j^-1 P_i)^-1 (G_j^-1 G_i) for estimate P and truth G: |trans(E)| in
/// metres and the angle of E in radians, for the whole delta (not divided by the time that really passed).
/// Nothing is aligned: relative poses need none.
struct RpeResult {
  std::string protocol = "tum";
  double delta = 0;
  DeltaUnit unit = DeltaUnit::seconds;
  std::size_t pairs = 0;
  std::size_t possible = 0;     ///< pairs of the estimate, before ground truth was requested
  std::size_t with_itself = 0;  ///< pairs of a pose with itself that the script has and that are left out
  double coverage = 0;
  double max_difference_s = 0;
  Alignment alignment;  ///< none
  std::vector<double> errors_m;
  std::vector<double> errors_rad;
  std::vector<std::int64_t> at_ns;  ///< of each error, the estimate's stamp at the motion's end
  /// Of more pairs than are listed, the errors one by one; the lists above are then empty.
  ValueSource streamed_m;
  ValueSource streamed_rad;
  metrics::Statistics translation;  ///< metres
  metrics::Statistics rotation;     ///< radians
};

/// Errors: configuration for a delta that makes no sense, data_corrupt for fewer than two poses on either
/// side or fewer than two pairs.
[[nodiscard]] Result<RpeResult> relative_pose_error(const Trajectory& ground_truth,
                                                    const Trajectory& estimate,
                                                    const RpeOptions& options = {});

}  // namespace fusebench::trajectory_error
