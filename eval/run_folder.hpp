// A run's folder appears whole or not at all: it is filled under a temporary name beside its place and then
// renamed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace fusebench {

class RunFolder {
 public:
  /// Creates the temporary folder beside `final_folder`, and the folders above it. Error io.
  [[nodiscard]] static Result<RunFolder> create(const std::filesystem::path& final_folder);

  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;
  /// Removes everything that was created, unless commit() succeeded.
  ~RunFolder();

  /// Where to write.
  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return temporary_ / name; }
  /// Writes a whole text file. Error io.
  [[nodiscard]] Result<void> write(std::string_view name, std::string_view text) const;
  /// Puts the folder into its place; a folder that is there is moved away first and then removed. Error io.
  [[nodiscard]] Result<void> commit();

 private:
  RunFolder() = default;

  std::filesystem::path final_;
  std::filesystem::path temporary_;             // empty once committed
  std::vector<std::filesystem::path> created_;  // parents that were not there before, outermost first
};

}  // namespace fusebench
