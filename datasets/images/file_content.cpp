#include "datasets/images/file_content.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <system_error>
#include <utility>

namespace fusebench::images {

Result<void> check_image_bytes(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size <= kMostImageBytes) return {};
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}: {} bytes are too many for an image (allowed: up to {})", file.string(), size,
                          kMostImageBytes),
              "is it another file by that name, or one that was not copied completely?");
}

ByteBuffer content_of(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return ByteBuffer(0);
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kMostImageBytes) return ByteBuffer(0);
  ByteBuffer content(size);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(content.bytes.get()), static_cast<std::streamsize>(size));
  return stream ? std::move(content) : ByteBuffer(0);
}

Result<void> check_unchanged(const std::filesystem::path& file, std::string_view content,
                             const std::optional<io::ContentHash>& opened) {
  if (!opened) return {};
  const io::ContentHash now = io::content_hash(content);
  if (now == *opened) return {};
  std::error_code error;
  const bool unreadable = content.empty() && (std::filesystem::file_size(file, error) > 0 || error);
  const std::string difference = unreadable ? "it cannot be read any more"
                                 : now.bytes == opened->bytes
                                     ? fmt::format("other content in its {} bytes", now.bytes)
                                     : fmt::format("{} bytes, before {}", now.bytes, opened->bytes);
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}: has changed since the recording was opened ({}); wait until it is written "
                          "completely and run again",
                          file.string(), difference));
}

}  // namespace fusebench::images
