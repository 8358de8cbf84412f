// Finds damage in PNG files before a decoder sees them.
#pragma once

#include <filesystem>
#include <string>

namespace fusebench::images {

/// What is wrong with a PNG file's chunks ("truncated PNG ...", "damaged PNG ..."), by their lengths and
/// checksums; empty if nothing is, or if the file is not a PNG (or cannot be read: whoever opens it next will
/// say so).
[[nodiscard]] std::string png_damage(const std::filesystem::path& file);

}  // namespace fusebench::images
