// Folders of runs as they lie on the disk: listed, tidied and brought together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "eval/run.hpp"

namespace fusebench {

struct ListedRun {
  std::filesystem::path folder;  ///< relative to the root
  RecordHead head;
  bool readable = true;  ///< false: what is called a record there cannot be read
};

/// Every run below a folder, by path; only the beginnings of records are read, so that tens of thousands take
/// a second or two. What is no readable record is a failed run with that reason. Error data_missing.
[[nodiscard]] Result<std::vector<ListedRun>> list_runs(const std::filesystem::path& root);

struct Garbage {
  bool failed = false;  ///< runs that failed, too
  bool stale = false;   ///< runs of another version of the estimator, too
  bool only_look = false;
};
struct GarbageReport {
  std::size_t temporaries = 0;  ///< folders and claims that killed processes left
  std::size_t runs = 0;
  std::uint64_t bytes = 0;
};
/// Removes what nobody needs. What a living engine works on stays. Errors: data_missing, io.
[[nodiscard]] Result<GarbageReport> collect_garbage(const std::filesystem::path& root,
                                                    const Garbage& garbage);

struct MergeReport {
  std::size_t copied = 0;
  std::size_t there = 0;      ///< finished runs of the same identity were there already
  std::size_t differing = 0;  ///< of those, with another status: the same identity must give the same results
};
/// Copies runs from one folder to another, each whole or not at all; a failed run gives way to a finished one
/// of its identity, and never the other way round. Errors: data_missing, io.
[[nodiscard]] Result<MergeReport> merge_runs(const std::filesystem::path& from,
                                             const std::filesystem::path& into);

}  // namespace fusebench
