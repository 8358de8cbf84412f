// A folder that appears whole or not at all, also after a power cut: it is filled under a temporary name
// beside its place, written through to the disk, and then renamed. Several for one place, also of other
// processes and machines, do not disturb each other: the last one that is committed stays.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::io {

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
  /// Writes every file and folder through to the disk and puts the folder into its place; a folder that is
  /// there is moved away first and then removed. Error io.
  [[nodiscard]] Result<void> commit();

 private:
  StagedFolder() = default;
  [[nodiscard]] std::error_code sync_places() const;

  std::filesystem::path final_;
  // Nobody else's: holds "new" and, on commit, "old", the folder that is replaced. Empty once committed.
  std::filesystem::path temporary_;
  int lock_ = -1;                               // of the temporary folder, for as long as this process lives
  std::vector<std::filesystem::path> created_;  // parents that were not there before, outermost first
};

/// Whether a folder is a temporary one of StagedFolder or of remove_whole(): ".<name>.<process>.tmp" or
/// ".<name>.<process>-<attempt>.tmp" that holds nothing but folders "new" and "old".
[[nodiscard]] bool is_staged_folder(const std::filesystem::path& folder);

/// Removes a folder whole or not at all: it is moved into a temporary folder beside it first, so that a kill
/// in the middle leaves no half of it.
[[nodiscard]] std::error_code remove_whole(const std::filesystem::path& folder);

/// Removes what processes that were killed left of their temporary folders in `parent`: those whose lock
/// nobody holds. Where a file system has no locks, only those that are older than a day. Returns them, or, if
/// it shall only look, those that there are to remove.
std::vector<std::filesystem::path> remove_abandoned(const std::filesystem::path& parent,
                                                    bool only_look = false);

}  // namespace fusebench::io
