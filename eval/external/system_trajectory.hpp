// The poses of another system, in any file that one writes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/trajectory_files/trajectory_formats.hpp"

namespace fusebench::external {

/// A file of one of the formats of trajectories or, if no format is said and its name ends in ".sens", the
/// poses in a .sens file, by the stamps of colour. Of stamps that are repeated a few times the last pose
/// counts. Errors: those of trajectory_files::load_trajectory() and exports::read_sens_trajectory().
[[nodiscard]] Result<trajectory_files::LoadedTrajectory> load_system_trajectory(
    const std::filesystem::path& file, std::optional<trajectory_files::TrajectoryFormat> format,
    std::vector<std::string>& warnings);

}  // namespace fusebench::external
