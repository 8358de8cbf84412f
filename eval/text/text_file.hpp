// Text files that are written atomically.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/base/error.hpp"

namespace fusebench::text {

/// Written beside its place and then renamed; the folders above it are created. Error io.
[[nodiscard]] Result<void> write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace fusebench::text
