// Images that a page carries within itself.
#pragma once

#include <string>

#include "core/base/types.hpp"

namespace fusebench::page {

/// The image as a JPEG data URI, quality 1 to 100; empty if it cannot be encoded.
[[nodiscard]] std::string jpeg_source(const ColorImage& image, int quality);

/// The image as a PNG data URI; empty if it cannot be encoded.
[[nodiscard]] std::string png_source(const ColorImage& image);

}  // namespace fusebench::page
