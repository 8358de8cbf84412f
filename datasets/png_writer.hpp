// Writes PNG files.
#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "datasets/pixel_view.hpp"

namespace fusebench {

/// Writes a PNG of one or three channels, whatever the file's name ends with. Not written: the reason.
[[nodiscard]] tl::expected<void, std::string> write_png_file(const std::filesystem::path& file,
                                                             const PixelView& image);

}  // namespace fusebench
