// Files that are read.
#pragma once

#include <filesystem>
#include <fstream>

namespace fusebench::io {

/// For reading, in binary; not open, with its failbit set, if that is no regular file: a pipe or a device in
/// the place of one would block for ever, or never end.
[[nodiscard]] std::ifstream input_file(const std::filesystem::path& file);

/// Something has that name, be it a link to nothing: what is named and cannot be read is an error, and not
/// absent.
[[nodiscard]] bool is_named(const std::filesystem::path& file);

}  // namespace fusebench::io
