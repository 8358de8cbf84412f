// Poses of two trajectories that belong together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::trajectory_files {

enum class AssociationRule {
  nearest,       ///< evo: see associate_nearest()
  greedy,        ///< TUM's associate.py, rpg: closest first, one to one, strictly within the limit
  index,         ///< KITTI: by order; both have as many poses
  number,        ///< by the number of the frame, which is the stamp in nanoseconds; either may have gaps
  interpolated,  ///< the reference at the estimate's stamps, within its gaps of at most the limit
  held,          ///< ETH3D: an estimate for every stamp that is evaluated, interpolated, or the nearest end's
};
[[nodiscard]] std::string_view to_string(AssociationRule rule);

struct AssociationOptions {
  AssociationRule rule = AssociationRule::nearest;
  double max_difference_s = 0.01;
  double offset_s = 0;  ///< added to the estimate's stamps
  /// Of the reference's own stamps; the estimate is not cut.
  double start_s = -std::numeric_limits<double>::infinity();
  double end_s = std::numeric_limits<double>::infinity();
  /// With `held`, where the reference is interpolated, within its gaps of at most the limit, and then
  /// compared: stamps of images, increasing. Empty: the reference's own.
  std::vector<std::int64_t> evaluated_ns = {};
};

/// As many poses on either side, each with its own stamp.
struct TrajectoryPair {
  Trajectory reference;
  Trajectory estimate;
  std::size_t possible = 0;  ///< poses of the shorter side, or stamps that were requested
  AssociationOptions options;

  [[nodiscard]] std::size_t size() const { return reference.size(); }
  [[nodiscard]] double coverage() const {
    return possible == 0 ? 0.0 : static_cast<double>(size()) / static_cast<double>(possible);
  }
};

/// The poses of the reference from options.start_s to options.end_s; nullopt if neither limits it.
[[nodiscard]] std::optional<Trajectory> in_range(const Trajectory& reference,
                                                 const AssociationOptions& options);

/// Stamps must increase on either side (nearest: any order). Errors data_corrupt: nothing matches, a range
/// that leaves nothing, or (index) trajectories of different length.
[[nodiscard]] Result<TrajectoryPair> pair_up(const Trajectory& reference, const Trajectory& estimate,
                                             const AssociationOptions& options);

}  // namespace fusebench::trajectory_files
