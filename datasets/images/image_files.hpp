// Reads and writes image files: colour (PNG, JPEG), grey with 8 and 16 bits (PNG). The only user of the image
// library, which is loaded on first use: for an image that is damaged or not a plain PNG (plain_png.hpp:
// colour, 16-bit grey).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/image.hpp"
#include "core/base/io/fingerprint.hpp"

namespace fusebench::images {

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// Image size from the header. Errors as below.
[[nodiscard]] Result<ImageSize> read_image_size(const std::filesystem::path& file);

/// Size in the header of a PNG, whatever its pixel format; nothing for other data or invalid sizes.
[[nodiscard]] std::optional<ImageSize> png_size(std::string_view bytes);

/// Reads a colour or grey image with 8 or 16 bits per channel. Grey gives three equal channels; alpha is
/// ignored, and transparent pixels keep their stored colour. 16 bits are reduced to 8: round(255 value /
/// 65535). expected: required size. opened: required content, that at the opening of the recording. Errors:
/// data_missing (no such file); data_corrupt (changed, unreadable, truncated, other channels, bit depth or
/// size); io (the image requires the image library, which is missing).
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

/// Decodes an image in memory: a PNG or JPEG as for read_color(), or a PNG with one channel of 16 bits. name:
/// source of the image for messages. Errors: data_corrupt, io as read_color().
[[nodiscard]] Result<ColorImage> decode_color(const std::string& name, std::string_view bytes);
[[nodiscard]] Result<Image<std::uint16_t>> decode_depth16(const std::string& name, std::string_view bytes);

/// Encodes a JPEG file in memory. quality: 1 to 100. Errors: io.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_jpeg(const ColorImage& image, int quality);

/// A PNG file in memory. Errors: io.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_png(const ColorImage& image);

/// Writes a PNG: 8-bit colour, 8-bit grey, 16-bit grey. Errors: io.
[[nodiscard]] Result<void> write_png(const std::filesystem::path& file, const ColorImage& image);
[[nodiscard]] Result<void> write_png(const std::filesystem::path& file, const GreyImage& image);
[[nodiscard]] Result<void> write_png(const std::filesystem::path& file, const Image<std::uint16_t>& image);

}  // namespace fusebench::images
