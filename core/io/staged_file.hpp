// A file that is written atomically: under a temporary name beside its place, and then renamed.
#pragma once

#include <filesystem>
#include <string_view>
#include <system_error>

namespace fusebench::io {

/// Several writers of one file, also in other processes, do not conflict: the last one stays. What killed
/// processes left of earlier ones is removed (remove_abandoned() says which). Nothing is left of a file that
/// cannot be written; its folder must be there.
[[nodiscard]] std::error_code write_file_atomically(const std::filesystem::path& file, std::string_view text);

/// Whether this is a file under a temporary name of write_file_atomically(): a plain one, no link.
[[nodiscard]] bool is_staged_file(const std::filesystem::path& file);

}  // namespace fusebench::io
