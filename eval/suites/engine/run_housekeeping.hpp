// Folders of runs as they lie on the disk: listed, tidied and brought together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/record/run_files/run_identity.hpp"
#include "eval/run/run.hpp"

namespace fusebench::engine {

struct ListedRun {
  std::filesystem::path folder;  ///< relative to the root
  run::RecordHead head;
  run_files::RunIdentity identity;
};

/// Every run below a folder, by path. What is damaged, or no record that can be read, is a failed run with
/// that reason; of the other files only the sizes are checked, unless their content shall be verified.
/// Error data_missing.
[[nodiscard]] Result<std::vector<ListedRun>> list_runs(const std::filesystem::path& root,
                                                       bool verify = false);

struct Garbage {
  bool failed = false;  ///< runs that failed or are damaged, too
  bool stale = false;   ///< runs of another version of the estimator, too
  bool only_look = false;
};
struct GarbageReport {
  std::size_t temporaries = 0;  ///< folders, files and claims that killed processes left
  std::size_t runs = 0;
  std::uint64_t bytes = 0;
  std::vector<std::filesystem::path> paths;  ///< of all of them, sorted
};
/// Removes what nobody needs of what this program wrote. What a living engine works on stays. Errors:
/// data_missing, also for a folder that holds no runs; io.
[[nodiscard]] Result<GarbageReport> collect_garbage(const std::filesystem::path& root,
                                                    const Garbage& garbage);

struct MergeReport {
  std::size_t copied = 0;
  std::size_t there = 0;      ///< finished runs of the same identity were there already
  std::size_t damaged = 0;    ///< not copied; those with links, pipes or devices in place of files as well
  std::size_t differing = 0;  ///< of those, with another status: the same identity must give the same results
  std::size_t damaged_invocations = 0;  ///< what `rerun` would do again: not copied
};
/// Copies runs from one folder to another, each atomically; a failed run gives way to a finished one
/// of its identity, and never the other way round. Errors: data_missing, io.
[[nodiscard]] Result<MergeReport> merge_runs(const std::filesystem::path& from,
                                             const std::filesystem::path& into);

}  // namespace fusebench::engine
