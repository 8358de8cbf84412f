// Writes PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "datasets/images/pixel_view.hpp"

namespace fusebench::images {

/// Encodes a PNG of one or three channels. Empty if memory is exhausted.
[[nodiscard]] std::vector<std::uint8_t> png_bytes(const PixelView& image);

/// Writes a PNG of one or three channels, whatever the extension of the file. On failure, returns the reason.
[[nodiscard]] tl::expected<void, std::string> write_png_file(const std::filesystem::path& file,
                                                             const PixelView& image);

}  // namespace fusebench::images
