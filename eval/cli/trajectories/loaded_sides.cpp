#include "eval/cli/trajectories/loaded_sides.hpp"

#include <utility>

#include "eval/cli/console/console.hpp"

namespace fusebench::cli::trajectories {

Result<Sides> load_sides(const std::filesystem::path& reference, const std::filesystem::path& estimate,
                         const SideReadings& readings, std::vector<std::string>& warnings) {
  auto first = trajectory_files::load_trajectory(reference, readings.reference, warnings);
  if (!first) return tl::unexpected(first.error());
  auto second = trajectory_files::load_trajectory(estimate, readings.estimate, warnings);
  if (!second) return tl::unexpected(second.error());
  return Sides{std::move(*first), std::move(*second)};
}

Result<Sides> load_sides(const std::filesystem::path& reference, const std::filesystem::path& estimate) {
  std::vector<std::string> warnings;
  auto sides = load_sides(reference, estimate, {}, warnings);
  console::print_warnings(warnings);
  return sides;
}

}  // namespace fusebench::cli::trajectories
