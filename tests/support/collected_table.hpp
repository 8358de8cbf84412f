// The table of all runs of a folder.
#pragma once

#include <filesystem>
#include <vector>

#include "eval/compare/tables/table.hpp"
#include "eval/record/run_files/found_runs.hpp"

namespace fusebench::testing {

/// Errors as find_runs().
[[nodiscard]] inline Result<tables::ResultTable> collect_table(const std::filesystem::path& runs) {
  return run_files::find_runs(runs).transform(
      [](const std::vector<run_files::FoundRun>& found) { return tables::table_of(found); });
}

}  // namespace fusebench::testing
