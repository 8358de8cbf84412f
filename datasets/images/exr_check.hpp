// What OpenEXR files claim in their headers, before a decoder makes room for it.
#pragma once

#include <filesystem>
#include <string>

namespace fusebench::images {

/// What is wrong with the headers of an OpenEXR file ("damaged OpenEXR ..."), by the sizes of their
/// attributes; empty if nothing is, or if the file is no OpenEXR (or cannot be read: whoever opens it next
/// will say so).
[[nodiscard]] std::string exr_damage(const std::filesystem::path& file);

}  // namespace fusebench::images
