// A folder that appears whole or not at all.
#pragma once

#include <filesystem>

#include "core/error.hpp"

namespace fusebench {

/// Filled under a temporary name beside its place, then put there; disappears if that does not happen.
class StagedFolder {
 public:
  explicit StagedFolder(std::filesystem::path final_folder);
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;
  ~StagedFolder();

  [[nodiscard]] Result<void> create();  ///< also the folders above it. Error io
  [[nodiscard]] Result<void> commit();  ///< Error io, also if the place is taken meanwhile
  [[nodiscard]] const std::filesystem::path& path() const { return staging_; }  ///< where to write

 private:
  std::filesystem::path final_;
  std::filesystem::path staging_;  // empty before create() and after commit()
};

}  // namespace fusebench
