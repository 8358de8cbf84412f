#include "eval/cli/evaluation/loaded_sides.hpp"

#include <string>
#include <utility>
#include <vector>

#include "eval/cli/console/console.hpp"

namespace fusebench::cli::evaluation {

Result<Sides> load_sides(const std::filesystem::path& reference, const std::filesystem::path& estimate,
                         const SideFormats& formats) {
  std::vector<std::string> warnings;
  auto first = trajectory_files::load_trajectory(reference, formats.reference, formats.duplicates, warnings);
  if (!first) return tl::unexpected(first.error());
  auto second = trajectory_files::load_trajectory(estimate, formats.estimate, formats.duplicates, warnings);
  if (!second) return tl::unexpected(second.error());
  for (const std::string& warning : warnings) console::print_progress("warning: " + warning);
  return Sides{std::move(*first), std::move(*second)};
}

}  // namespace fusebench::cli::evaluation
