// The bytes of a file in memory, and a check that they have not changed since the recording was opened.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "core/io/fingerprint.hpp"

namespace fusebench::images {

/// A buffer of uninitialised bytes, unlike a vector.
struct ByteBuffer {
  std::size_t size = 0;
  std::unique_ptr<std::uint8_t[]> bytes;

  explicit ByteBuffer(std::size_t count)
      : size(count), bytes(std::make_unique_for_overwrite<std::uint8_t[]>(count)) {}
  [[nodiscard]] std::string_view text() const { return {reinterpret_cast<const char*>(bytes.get()), size}; }
};

/// Of an image file: more are refused before they are read, as a file can be as long as its disk, and one
/// with holes longer.
inline constexpr std::uintmax_t kMostImageBytes = std::uintmax_t{1} << 29;

/// Error data_corrupt: the file has more than kMostImageBytes. A file that is not there has none.
[[nodiscard]] Result<void> check_image_bytes(const std::filesystem::path& file);

/// Empty if it cannot be read, or has more than kMostImageBytes; folders and devices have no content of a
/// known size.
[[nodiscard]] ByteBuffer content_of(const std::filesystem::path& file);

/// Compares the bytes that were read now with those of the opening; no `opened`: nothing to compare with.
/// Error data_corrupt: they differ.
[[nodiscard]] Result<void> check_unchanged(const std::filesystem::path& file, std::string_view content,
                                           const std::optional<io::ContentHash>& opened);

}  // namespace fusebench::images
