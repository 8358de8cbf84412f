// Image files: colour (PNG, JPEG), grey with 8 and 16 bits (PNG). The only user of the image
// library, which is loaded by the first image that it is needed for: one that is not a plain PNG of a
// recording (plain_png.hpp: colour, 16-bit grey), or damaged.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/image.hpp"
#include "core/io/fingerprint.hpp"

namespace fusebench::images {

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// Size as the header says. Errors as below.
[[nodiscard]] Result<ImageSize> read_image_size(const std::filesystem::path& file);

/// The size that a PNG claims, whatever its pixels are; nothing for other bytes, or a size that no image has.
[[nodiscard]] std::optional<ImageSize> png_size(std::string_view bytes);

/// Reads a colour or grey image with 8 or 16 bits a channel. Grey gives three equal channels; alpha is left
/// out, and the colour of transparent pixels is as stored. 16 bits become 8: round(255 value / 65535).
/// expected: the size that it must have; opened: the bytes that the file must have, those which it had when
/// its recording was opened.
/// Errors: data_missing (no such file); data_corrupt (changed, unreadable, truncated, other channels, bit
/// depth or size); io (there is no image library, and this image needs it).
[[nodiscard]] Result<ColorImage> read_color(const std::filesystem::path& file,
                                            std::optional<ImageSize> expected = std::nullopt,
                                            const std::optional<io::ContentHash>& opened = std::nullopt);

/// Reads an image with one channel of 8 bits. Errors as read_color().
[[nodiscard]] Result<GreyImage> read_grey(const std::filesystem::path& file,
                                          std::optional<ImageSize> expected = std::nullopt);

/// Reads an image with one channel of 16 bits, raw values. Errors as read_color().
[[nodiscard]] Result<Image<std::uint16_t>> read_depth16(
    const std::filesystem::path& file, std::optional<ImageSize> expected = std::nullopt,
    const std::optional<io::ContentHash>& opened = std::nullopt);

/// Reads the first channel of an image of floating-point numbers (OpenEXR), raw values. Errors as
/// read_color().
[[nodiscard]] Result<Image<float>> read_float(const std::filesystem::path& file,
                                              std::optional<ImageSize> expected = std::nullopt,
                                              const std::optional<io::ContentHash>& opened = std::nullopt);

/// Decodes an image in memory: a PNG or JPEG as read_color() takes it, or a PNG with one channel of 16 bits.
/// name: says in messages where it is from. Errors: data_corrupt, io as read_color().
[[nodiscard]] Result<ColorImage> decode_color(const std::string& name, std::string_view bytes);
[[nodiscard]] Result<Image<std::uint16_t>> decode_depth16(const std::string& name, std::string_view bytes);

/// A JPEG file in memory. quality: 1 to 100. Errors: io.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_jpeg(const ColorImage& image, int quality);

/// A PNG file in memory. Errors: io.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_png(const ColorImage& image);

/// Writes a PNG: 8-bit colour, 8-bit grey, 16-bit grey. Errors: io.
[[nodiscard]] Result<void> write_png(const std::filesystem::path& file, const ColorImage& image);
[[nodiscard]] Result<void> write_png(const std::filesystem::path& file, const GreyImage& image);
[[nodiscard]] Result<void> write_png(const std::filesystem::path& file, const Image<std::uint16_t>& image);

}  // namespace fusebench::images
