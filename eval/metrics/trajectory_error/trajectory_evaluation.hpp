// One trajectory against another by a protocol: the numbers, and all that they depend on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/metrics/trajectory_error/alignment.hpp"
#include "eval/metrics/trajectory_error/fitted_offset.hpp"
#include "eval/metrics/trajectory_error/protocol.hpp"
#include "eval/metrics/trajectory_error/streamed_statistics.hpp"
#include "eval/metrics/trajectory_error/trajectory_error.hpp"

namespace fusebench::trajectory_error {

/// One kind of error: of poses, of motions, or of segments.
struct ErrorSeries {
  std::string relation;  ///< evo's name of it; of segments "translation_percent" or "rotation_deg_per_m"
  std::string unit;      ///< "m", "%", "rad", "deg", "deg/m", or "" of what has none
  std::vector<double> errors;
  std::vector<std::int64_t> at_ns;  ///< of each error: the stamp of the pose, or of the motion's end
  /// Where poses are kept: of each error, its pose among the compared (of a motion: its end). Empty of
  /// segments and of TUM's motions.
  std::vector<std::size_t> at = {};
  /// Of more motions than are listed, the errors one by one; the lists above are then empty.
  ValueSource streamed;
  metrics::Statistics stats;
};

/// Segments of one length.
struct SegmentRow {
  double length_m = 0;
  std::size_t segments = 0;
  metrics::Statistics translation_m;
  metrics::Statistics translation_percent;
  metrics::Statistics rotation_deg;
  metrics::Statistics rotation_deg_per_m;
  metrics::Statistics yaw_deg;
  metrics::Statistics gravity_deg;
};

struct TrajectoryEvaluation {
  TrajectoryRequest request;
  std::size_t reference_poses = 0;
  std::size_t estimate_poses = 0;
  std::size_t pairs = 0;     ///< associated poses; of TUM's relative error, motions with ground truth
  std::size_t possible = 0;  ///< that there could have been
  double coverage = 0;       ///< pairs / possible
  /// Share of the reference's time that the estimate covers (trajectory::covered_share_of_time); a tracker
  /// that stops early has a coverage of 1, but a small share here. Nothing of poses without stamps.
  std::optional<double> time_coverage;
  std::size_t with_itself = 0;      ///< of TUM's relative error: see RpeResult
  Similarity alignment;             ///< reference from estimate
  std::vector<ErrorSeries> series;  ///< the first is the protocol's own number
  /// Empty unless request.keep_poses. Of TUM's relative errors: all poses, the estimate's scaled.
  ComparedPoses compared;
  std::vector<SegmentRow> segments;           ///< where segments are what is compared
  std::optional<FittedOffset> fitted_offset;  ///< where it was requested; its errors are the second series
};

/// The same errors in another unit of the kind: mm, cm or km of metres, degrees of radians or the other way
/// round. Error usage: it is another kind.
[[nodiscard]] Result<void> change_unit(ErrorSeries& series, const std::string& unit);

/// Errors: configuration for deltas that make no sense, data_corrupt for trajectories that do not match or do
/// not determine the alignment or an offset that was requested, and where no motion is left.
[[nodiscard]] Result<TrajectoryEvaluation> evaluate(const Trajectory& reference, const Trajectory& estimate,
                                                    const TrajectoryRequest& request);

}  // namespace fusebench::trajectory_error
