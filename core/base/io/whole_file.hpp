// A file that is written in one piece.
#pragma once

#include <filesystem>
#include <string_view>
#include <system_error>

namespace fusebench::io {

/// Creates or replaces the file. What the operating system said if that failed, with a part of the file
/// written: no space left, a read-only file system, no such folder.
[[nodiscard]] std::error_code write_whole_file(const std::filesystem::path& file, std::string_view text);

}  // namespace fusebench::io
