// A file that lies in memory and yet has paths, for readers that open what they read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace fusebench::fuzz {

/// Its names are links in a folder, so that a reader which looks for a file there finds it.
class MemoryFile {
 public:
  /// name: of the file within a temporary folder of its own. Throws when the system has no memory files.
  explicit MemoryFile(const std::string& name);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// Another name for the same bytes, within the folder.
  void also_call(const std::string& name) const;

  /// Replaces the content.
  void write(std::string_view bytes) const;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  int descriptor_;
  std::filesystem::path folder_;
  std::filesystem::path path_;
};

}  // namespace fusebench::fuzz
