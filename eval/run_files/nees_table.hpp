// nees.csv: the consistency of a run's filter frame by frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/record/record.hpp"

namespace fusebench::run_files {

/// Columns capture_timestamp, part (of kStateParts), nees_per_dof; by part, then in order of time. Empty if
/// no part has a value.
[[nodiscard]] std::string nees_table(const record::RecordedNees& nees);

struct NeesTableRow {
  std::int64_t capture_ns = 0;
  std::string part;
  double nees_per_dof = 0;
};

/// Errors: data_missing; data_corrupt for what is no such table.
[[nodiscard]] Result<std::vector<NeesTableRow>> read_nees_table(const std::filesystem::path& file);

}  // namespace fusebench::run_files
