// Text of files that may be anything: 60 GB of holes are one line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>
#include <string_view>

#include "core/base/error.hpp"

namespace fusebench::io {

inline constexpr std::size_t kMostLineBytes = std::size_t{1} << 20;

/// std::getline(), but that a line of more than kMostLineBytes is the end of the file, and makes the stream
/// bad().
[[nodiscard]] bool next_line(std::istream& stream, std::string& line);

/// All of a regular file. Errors: data_missing (no such file, not readable), data_corrupt (larger than
/// `most_bytes`; what: of what kind it was to be, "record").
[[nodiscard]] Result<std::string> whole_text(const std::filesystem::path& file, std::uintmax_t most_bytes,
                                             std::string_view what);

}  // namespace fusebench::io
