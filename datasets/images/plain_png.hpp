// Fast decoder for the PNG files of recordings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/base/image.hpp"
#include "datasets/images/file_content.hpp"

namespace fusebench::images {

/// Decodes a PNG with 8-bit red, green and blue or 16-bit grey, not interlaced, without transparency, with
/// valid chunks and checksums. Nothing for any other file, valid or not; use the image library then.
[[nodiscard]] std::optional<ColorImage> decode_plain_png_color(ByteBuffer content);
[[nodiscard]] std::optional<Image<std::uint16_t>> decode_plain_png_grey16(ByteBuffer content);
[[nodiscard]] std::optional<ColorImage> read_plain_png_color(const std::filesystem::path& file);
[[nodiscard]] std::optional<Image<std::uint16_t>> read_plain_png_grey16(const std::filesystem::path& file);

}  // namespace fusebench::images
