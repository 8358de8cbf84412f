// Content of a file in memory, and a check that the file has not changed since the recording was opened.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/io/fingerprint.hpp"

namespace fusebench::images {

/// A buffer of uninitialised bytes, unlike std::vector.
struct ByteBuffer {
  std::size_t size = 0;
  std::unique_ptr<std::uint8_t[]> bytes;

  explicit ByteBuffer(std::size_t count)
      : size(count), bytes(std::make_unique_for_overwrite<std::uint8_t[]>(count)) {}
  [[nodiscard]] std::string_view text() const { return {reinterpret_cast<const char*>(bytes.get()), size}; }
};

/// Size limit of an image file, checked before reading: a file may be as large as its disk, a sparse file
/// larger.
inline constexpr std::uintmax_t kMostImageBytes = std::uintmax_t{1} << 29;

/// Error data_corrupt: the file exceeds kMostImageBytes. A missing file passes.
[[nodiscard]] Result<void> check_image_bytes(const std::filesystem::path& file);

/// Reads a file; empty if it cannot be read or exceeds kMostImageBytes. Folders and devices count as
/// unreadable.
[[nodiscard]] ByteBuffer content_of(const std::filesystem::path& file);

/// Compares the content with that at the opening of the recording; without `opened`, does nothing. Error
/// data_corrupt: they differ.
[[nodiscard]] Result<void> check_unchanged(const std::filesystem::path& file, std::string_view content,
                                           const std::optional<io::ContentHash>& opened);

}  // namespace fusebench::images
