// The finished runs of a folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "eval/record.hpp"

namespace fusebench {

struct FoundRun {
  std::filesystem::path folder;
  RunRecord record;
};

/// Place of a variant in the order of all_variants(); another one comes after them.
[[nodiscard]] std::size_t variant_rank(const std::string& variant);

/// Every record.json below a folder, in no order; hidden folders are unfinished runs and are skipped. Error
/// data_missing if the folder cannot be listed.
[[nodiscard]] Result<std::vector<std::filesystem::path>> record_files(const std::filesystem::path& runs);

/// That there are none in a folder: error data_missing.
[[nodiscard]] tl::unexpected<Error> holds_no_runs(const std::filesystem::path& runs);

/// Every record.json below a folder (hidden folders are unfinished runs and are skipped), by recording (name,
/// then content), then variant in the order of all_variants(), then run. Errors: data_missing (no folder, no
/// records), data_corrupt (a record that cannot be read).
[[nodiscard]] Result<std::vector<FoundRun>> find_runs(const std::filesystem::path& runs);

}  // namespace fusebench
