// A reference and an estimate, as the verbs that compare two trajectories load them.
#pragma once

#include <filesystem>
#include <optional>

#include "core/base/error.hpp"
#include "core/trajectory/trajectory_file.hpp"
#include "eval/trajectory_files/trajectory_formats.hpp"

namespace fusebench::cli::evaluation {

struct Sides {
  trajectory_files::LoadedTrajectory reference;
  trajectory_files::LoadedTrajectory estimate;
  [[nodiscard]] bool have_stamps() const { return reference.has_stamps() && estimate.has_stamps(); }
};

/// How the two files are read; without a format, their first rows tell it.
struct SideFormats {
  std::optional<trajectory_files::TrajectoryFormat> reference = {};
  std::optional<trajectory_files::TrajectoryFormat> estimate = {};
  trajectory::Duplicates duplicates = trajectory::Duplicates::rare_last;
};

/// Reads both and prints what was noticed as warnings. Errors: those of load_trajectory().
[[nodiscard]] Result<Sides> load_sides(const std::filesystem::path& reference,
                                       const std::filesystem::path& estimate,
                                       const SideFormats& formats = {});

}  // namespace fusebench::cli::evaluation
