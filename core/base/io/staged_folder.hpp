// A folder that is written atomically and durably: it is filled under a temporary name beside its
// destination, synced to the disk, and then renamed. Several writers of one destination, also in other
// processes and on other machines, do not conflict: the last commit wins.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/temporary_mark.hpp"

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
  /// Syncs every file and folder to the disk and renames the folder to its destination; an existing folder is
  /// moved away first and then removed. Error io.
  [[nodiscard]] Result<void> commit();

 private:
  StagedFolder() = default;
  void mark_temporary();

  std::filesystem::path final_;
  // Nobody else's: holds "new" and, on commit, "old", the folder that is replaced. Empty once committed.
  std::filesystem::path temporary_;
  int lock_ = -1;                               // of the temporary folder, for as long as this process lives
  std::vector<std::filesystem::path> created_;  // parents that were not there before, outermost first
  std::vector<TemporaryMark> marks_;            // of the temporary folder and the parents
};

/// Syncs a file or folder to the disk, so that it survives a power failure. EINVAL and ENOTSUP mean that the
/// file system cannot sync it and are ignored; any other error is returned.
[[nodiscard]] std::error_code sync_to_disk(const std::filesystem::path& place);

/// Syncs the names on a path to the disk: its folder, and then those above, each once. Without them, what is
/// in the folder would not be there after a power failure. Ends at the first error of its folder, or of one
/// that holds the name of a `made` folder (parents of `path`, spelt as there), and returns it; others above
/// are synced as far as they can be.
[[nodiscard]] std::error_code sync_names(const std::filesystem::path& path,
                                         std::span<const std::filesystem::path> made = {});

/// Whether a folder is a temporary one of StagedFolder or of remove_atomically(): ".<name>.<process>.tmp" or
/// ".<name>.<process>-<attempt>.tmp" that holds nothing but folders "new" and "old".
[[nodiscard]] bool is_staged_folder(const std::filesystem::path& folder);

/// Removes a folder atomically: it is moved into a temporary folder beside it first, so that a kill in the
/// middle leaves no half of it.
[[nodiscard]] std::error_code remove_atomically(const std::filesystem::path& folder);

}  // namespace fusebench::io
