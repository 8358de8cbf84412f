// Bytes from the middle of a file: images are read when they are needed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/base/error.hpp"

namespace fusebench::image_logs {

/// Errors: data_missing, data_corrupt (the file ends before).
[[nodiscard]] Result<std::string> bytes_of_file(const std::filesystem::path& file, std::uint64_t position,
                                                std::uint64_t count);

}  // namespace fusebench::image_logs
