// Netpbm images: binary PPM (P6, colour of 8 bits) and PGM (P5, grey of 16 bits), as InfiniTAM reads them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/base/error.hpp"
#include "core/base/image.hpp"

namespace fusebench::exports {

/// "P6\n<width> <height>\n255\n", then red, green, blue.
[[nodiscard]] std::string ppm_bytes(const ColorImage& image);

/// "P5\n<width> <height>\n65535\n", then big-endian 16-bit values.
[[nodiscard]] std::string pgm_bytes(const Image<std::uint16_t>& image);

/// Reads such a file, with any white space between the numbers and with comments. Errors: data_missing;
/// data_corrupt (another kind or range of values, too few bytes).
[[nodiscard]] Result<ColorImage> read_ppm(const std::filesystem::path& file);
[[nodiscard]] Result<Image<std::uint16_t>> read_pgm(const std::filesystem::path& file);

}  // namespace fusebench::exports
