#include "datasets/images/png_check.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string_view>

#include "core/base/io/input_file.hpp"

namespace fusebench::images {

namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<std::uint8_t>(c);
  return value;
}

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace

std::optional<ClaimedSize> png_claim(std::string_view bytes) {
  constexpr std::size_t kWidth = 16;  // offset after the signature and the length and type of the first chunk
  constexpr std::size_t kHeight = kWidth + 4;
  if (bytes.size() < kHeight + 4 || !bytes.starts_with(kSignature) || bytes.substr(12, 4) != "IHDR")
    return std::nullopt;
  return ClaimedSize{big_endian(bytes.substr(kWidth)), big_endian(bytes.substr(kHeight))};
}

// The decoder ignores checksums, fills truncated images with black, and prints other errors to standard
// error.
std::string png_damage(const std::filesystem::path& file) {
  std::ostringstream content;
  content << io::input_file(file).rdbuf();
  const std::string_view bytes = content.view();
  if (!bytes.starts_with(kSignature)) return {};

  // Chunk layout: data length, four letters of the type, data, checksum of type and data.
  constexpr std::size_t kFrame = 12;
  std::string_view rest = bytes.substr(kSignature.size());
  while (true) {
    const std::size_t length = rest.size() >= kFrame ? big_endian(rest) : 0;
    if (rest.size() < kFrame + length) {
      return fmt::format("truncated PNG (its end is missing after {} bytes)", bytes.size());
    }
    const std::string_view type_and_data = rest.substr(4, 4 + length);
    if (checksum(type_and_data) != big_endian(rest.substr(8 + length))) {
      return fmt::format("damaged PNG (checksum of the chunk at byte {})", bytes.size() - rest.size());
    }
    if (type_and_data.starts_with("IEND")) return {};
    rest.remove_prefix(kFrame + length);
  }
}

}  // namespace fusebench::images
