// A folder that appears whole or not at all: it is filled under a temporary name beside its place and then
// renamed.
#pragma once

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

  /// Where to write: the temporary folder, and a file in it.
  [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }
  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return temporary_ / name; }
  /// Writes a whole text file. Error io.
  [[nodiscard]] Result<void> write(std::string_view name, std::string_view text) const;
  /// Puts the folder into its place; a folder that is there is moved away first and then removed. Error io.
  [[nodiscard]] Result<void> commit();

 private:
  StagedFolder() = default;

  std::filesystem::path final_;
  std::filesystem::path temporary_;             // empty once committed
  std::vector<std::filesystem::path> created_;  // parents that were not there before, outermost first
};

}  // namespace fusebench
