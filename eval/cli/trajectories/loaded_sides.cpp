#include "eval/cli/trajectories/loaded_sides.hpp"

#include <utility>

#include "eval/cli/console/console.hpp"

namespace fusebench::cli::trajectories {

Result<void> set_stamp_units(const std::string& units, SideReadings& readings) {
  if (units.empty()) return {};
  const std::size_t comma = units.find(',');
  const auto first = trajectory_files::parse_stamp_unit(units.substr(0, comma));
  if (!first) return tl::unexpected(first.error());
  readings.reference.stamp_unit = *first;
  readings.estimate.stamp_unit = *first;
  if (comma == std::string::npos) return {};
  const auto second = trajectory_files::parse_stamp_unit(units.substr(comma + 1));
  if (!second) return tl::unexpected(second.error());
  readings.estimate.stamp_unit = *second;
  readings.reference.unit_of_this_file = true;
  readings.estimate.unit_of_this_file = true;
  return {};
}

metric_reports::ComparedFiles compared_files(const std::string& reference, const std::string& estimate,
                                             const Sides& sides) {
  return {reference,
          sides.reference.format,
          estimate,
          sides.estimate.format,
          sides.reference.format_source,
          sides.estimate.format_source};
}

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
