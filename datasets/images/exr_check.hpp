// Checks the headers of OpenEXR files before a decoder allocates memory for them.
#pragma once

#include <filesystem>
#include <string>

namespace fusebench::images {

/// Describes damage in the headers of an OpenEXR file ("damaged OpenEXR ..."), by the sizes of its
/// attributes. Empty if there is none, if the file is not OpenEXR, or if it cannot be read (the decoder
/// reports that).
[[nodiscard]] std::string exr_damage(const std::filesystem::path& file);

}  // namespace fusebench::images
