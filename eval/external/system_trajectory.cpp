#include "eval/external/system_trajectory.hpp"

#include <utility>

#include "datasets/exports/sens_file.hpp"

namespace fusebench::external {

Result<trajectory_files::LoadedTrajectory> load_system_trajectory(
    const std::filesystem::path& file, std::optional<trajectory_files::TrajectoryFormat> format,
    std::vector<std::string>& warnings) {
  if (format || file.extension() != ".sens")
    return trajectory_files::load_trajectory(file, format, trajectory::Duplicates::rare_last, warnings);
  auto poses = exports::read_sens_trajectory(file);
  if (!poses) return tl::unexpected(poses.error());
  return trajectory_files::LoadedTrajectory{trajectory_files::TrajectoryFormat::tum, std::move(*poses), {}};
}

}  // namespace fusebench::external
