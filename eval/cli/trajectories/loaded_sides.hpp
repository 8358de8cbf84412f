// A reference and an estimate, as the verbs that compare two trajectories load them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/trajectory_files/trajectory_formats.hpp"

namespace fusebench::cli::trajectories {

struct Sides {
  trajectory_files::LoadedTrajectory reference;
  trajectory_files::LoadedTrajectory estimate;
  [[nodiscard]] bool have_stamps() const { return reference.has_stamps() && estimate.has_stamps(); }
};

/// How the two files are read; what is not given is recognised.
struct SideReadings {
  trajectory_files::TrajectoryReading reference = {};
  trajectory_files::TrajectoryReading estimate = {};
};

/// Reads both. Errors: those of load_trajectory().
[[nodiscard]] Result<Sides> load_sides(const std::filesystem::path& reference,
                                       const std::filesystem::path& estimate, const SideReadings& readings,
                                       std::vector<std::string>& warnings);

/// The same, with what was noticed printed as warnings.
[[nodiscard]] Result<Sides> load_sides(const std::filesystem::path& reference,
                                       const std::filesystem::path& estimate);

}  // namespace fusebench::cli::trajectories
