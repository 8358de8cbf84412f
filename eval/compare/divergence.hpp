// Where two runs of one recording part.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/error.hpp"

namespace fusebench::compare {

/// The first frame whose pose is not the same to the last digit, or that only one side tracked.
struct Divergence {
  std::size_t frame = 0;             ///< of frames.csv; without one, the row of the trajectory, from 0
  std::string stamp;                 ///< as the trajectory has it, seconds
  std::optional<double> moved_m;     ///< between both positions; absent if one side has no pose
  std::optional<double> turned_rad;  ///< between both rotations
  std::string only_in;               ///< "BASE" or "NEW" if only that side tracked the frame

  /// "differs from frame 12 on (stamp 0.400000000): moved by 0.031 mm"
  [[nodiscard]] std::string text() const;
};

/// Whether a run's folder has a trajectory.
[[nodiscard]] bool has_trajectory(const std::filesystem::path& run);

/// Compares trajectory.tum of two folders of runs row by row, by stamp; nothing if they are the same. Errors,
/// with file:line: data_missing; data_corrupt for a row that is not a stamp and seven finite numbers.
[[nodiscard]] Result<std::optional<Divergence>> first_divergence(const std::filesystem::path& base,
                                                                 const std::filesystem::path& fresh);

}  // namespace fusebench::compare
