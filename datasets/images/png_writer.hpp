// Writes PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "datasets/images/pixel_view.hpp"

namespace fusebench::images {

/// A PNG of one or three channels. Empty if there is not enough memory for the compressor.
[[nodiscard]] std::vector<std::uint8_t> png_bytes(const PixelView& image);

/// Writes a PNG of one or three channels, whatever the file's name ends with. Not written: the reason.
[[nodiscard]] tl::expected<void, std::string> write_png_file(const std::filesystem::path& file,
                                                             const PixelView& image);

}  // namespace fusebench::images
