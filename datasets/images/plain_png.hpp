// The PNG files that recordings are made of, decoded several times faster than by a library for all of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/base/image.hpp"
#include "datasets/images/file_content.hpp"

namespace fusebench::images {

/// A PNG with red, green and blue of 8 bits, or grey of 16, neither interlaced nor with transparency, whose
/// chunks and checksums are in order. None for any other file, sound or not: then a complete decoder has to
/// decode or diagnose it.
[[nodiscard]] std::optional<ColorImage> decode_plain_png_color(ByteBuffer content);
[[nodiscard]] std::optional<Image<std::uint16_t>> decode_plain_png_grey16(ByteBuffer content);
[[nodiscard]] std::optional<ColorImage> read_plain_png_color(const std::filesystem::path& file);
[[nodiscard]] std::optional<Image<std::uint16_t>> read_plain_png_grey16(const std::filesystem::path& file);

}  // namespace fusebench::images
