// A file that is written atomically: under a temporary name beside its place, and then renamed.
#pragma once

#include <filesystem>
#include <string_view>
#include <system_error>
#include <tl/expected.hpp>

#include "core/base/io/temporary_mark.hpp"

namespace fusebench::io {

/// A file that is being written. Several writers of one file, also in other processes, do not conflict: the
/// last one stays. What killed processes left of earlier ones is removed (remove_abandoned() says which), and
/// nothing is left of a file that was not committed.
class StagedFile {
 public:
  /// An empty file beside the place, whose folder must be there. A symbolic link is replaced, whatever it
  /// leads to: its target may belong to somebody else. A device, a pipe, a folder, and a link in /dev or
  /// /proc (standard output) are opened as they are. What the operating system said if that failed.
  [[nodiscard]] static tl::expected<StagedFile, std::error_code> create(const std::filesystem::path& place);

  StagedFile(StagedFile&& other) noexcept;
  StagedFile& operator=(StagedFile&&) = delete;
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;
  ~StagedFile();

  /// Where to write.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// As it was named: for messages.
  [[nodiscard]] const std::filesystem::path& place() const { return place_; }

  /// Gives the file its name.
  [[nodiscard]] std::error_code commit();

 private:
  StagedFile() = default;

  std::filesystem::path place_;
  std::filesystem::path path_;
  std::filesystem::path final_;  ///< empty if path_ needs no other name
  int lock_ = -1;                ///< -1: the file system has none
  TemporaryMark mark_;
};

/// Whether a file of this name would replace a symbolic link: not one to a folder, and not in /dev or /proc.
[[nodiscard]] bool is_replaced_link(const std::filesystem::path& place);

/// All of a file as a StagedFile.
[[nodiscard]] std::error_code write_file_atomically(const std::filesystem::path& file, std::string_view text);

/// Whether this is a file under a temporary name of a StagedFile: a plain one, no link.
[[nodiscard]] bool is_staged_file(const std::filesystem::path& file);

}  // namespace fusebench::io
