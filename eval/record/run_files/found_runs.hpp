// The runs of a folder, whole or damaged.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "eval/record/record.hpp"

namespace fusebench::run_files {

/// What is left of a run that was finished.
enum class RunState {
  whole,
  damaged,     ///< its record is no record, or one of its files has another size than was recorded
  unreadable,  ///< its record cannot be opened, or is one of another version of this program
};

/// Of a run that is not whole the record is a failed one that says why, without numbers; recording and
/// variant are those of its folder's name where the record does not say them.
struct FoundRun {
  std::filesystem::path folder;
  record::RunRecord record;
  RunState state = RunState::whole;
};

/// The folder of what engines keep among runs.
inline constexpr std::string_view kEngineFolderName = ".fusebench";

/// Whether a folder is what engines keep among runs: of that name, and holding nothing else than what they
/// do.
[[nodiscard]] bool is_engine_folder(const std::filesystem::path& folder);

/// Recording and variant of a run as the names of the folders above it say them.
struct PlaceOfRun {
  std::string recording;
  std::string variant;
};
[[nodiscard]] PlaceOfRun place_of_run(const std::filesystem::path& folder);

/// Place of a variant in the order of all_variants(); another one comes after them.
[[nodiscard]] std::size_t variant_rank(const std::string& variant);

/// Every record.json below a folder, in no order; those in staged folders belong to unfinished runs and are
/// skipped. Error data_missing if the folder cannot be listed.
[[nodiscard]] Result<std::vector<std::filesystem::path>> record_files(const std::filesystem::path& runs);

/// That there are none in a folder: error data_missing.
[[nodiscard]] tl::unexpected<Error> holds_no_runs(const std::filesystem::path& runs);

/// The run in a folder, by its record and the sizes of its files; nothing if there is no record.
[[nodiscard]] std::optional<FoundRun> found_run(const std::filesystem::path& folder);

/// Every run below a folder as record_files() finds them, by recording (name, then content), then variant in
/// the order of all_variants(), then edited options (numbers by value), then run. Error data_missing: no
/// folder, no records.
[[nodiscard]] Result<std::vector<FoundRun>> find_runs(const std::filesystem::path& runs);

}  // namespace fusebench::run_files
