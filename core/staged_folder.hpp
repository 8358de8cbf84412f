// A folder that appears whole or not at all: it is filled under a temporary name beside its place and then
// renamed. Several for one place, also of other processes and machines, do not disturb each other: the last
// one that is committed stays.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace fusebench {

class StagedFolder {
 public:
  /// Creates the temporary folder beside `final_folder`, and the folders above it. Error io.
  [[nodiscard]] static Result<StagedFolder> create(const std::filesystem::path& final_folder);

  StagedFolder(StagedFolder&& other) noexcept;
  StagedFolder& operator=(StagedFolder&&) = delete;
  /// Removes everything that was created, unless commit() succeeded.
  ~StagedFolder();

  /// Where to write: a folder in the temporary one, and a file in it.
  [[nodiscard]] std::filesystem::path path() const { return temporary_ / "new"; }
  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return path() / name; }
  /// Writes a whole text file. Error io.
  [[nodiscard]] Result<void> write(std::string_view name, std::string_view text) const;
  /// Puts the folder into its place; a folder that is there is moved away first and then removed. Error io.
  [[nodiscard]] Result<void> commit();

 private:
  StagedFolder() = default;

  std::filesystem::path final_;
  // Nobody else's: holds "new" and, on commit, "old", the folder that is replaced. Empty once committed.
  std::filesystem::path temporary_;
  int lock_ = -1;                               // of the temporary folder, for as long as this process lives
  std::vector<std::filesystem::path> created_;  // parents that were not there before, outermost first
};

/// Removes what processes that were killed left of their staged folders in `parent`: a folder whose lock
/// nobody holds. Where a file system has no locks, only those that are older than a day. Returns how many, or
/// how many there are to remove.
std::size_t remove_abandoned(const std::filesystem::path& parent, bool only_count = false);

}  // namespace fusebench
