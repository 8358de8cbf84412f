#include "datasets/images/exr_check.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <system_error>

#include "core/base/io/input_file.hpp"
#include "core/base/printable.hpp"

namespace fusebench::images {

namespace {

constexpr std::size_t kMostName = 255;  // limit of the format, without the NUL

std::optional<std::uint32_t> little_endian(std::istream& stream) {
  std::array<char, 4> bytes{};
  if (!stream.read(bytes.data(), bytes.size())) return std::nullopt;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    value |= std::uint32_t{static_cast<std::uint8_t>(bytes[i])} << (8 * i);
  return value;
}

/// Reads a NUL-terminated string.
std::optional<std::string> name_of(std::istream& stream) {
  std::string name;
  for (char c = 0; stream.get(c);) {
    if (c == '\0') return name;
    if (name.size() == kMostName) return std::nullopt;
    name += c;
  }
  return std::nullopt;
}

}  // namespace

// The decoder allocates and zeroes memory for an attribute of any size before it reads it.
std::string exr_damage(const std::filesystem::path& file) {
  constexpr std::uint32_t kMagic = 20000630;
  constexpr std::uint32_t kHasParts = 0x1000;
  constexpr std::uint64_t kFrame = 8;  // magic number and version
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  std::ifstream stream = io::input_file(file);
  if (error || little_endian(stream) != kMagic) return {};
  const std::uint32_t version = little_endian(stream).value_or(0);

  // An attribute consists of name, type, size and value. An empty name ends a header, and an empty header
  // ends the headers of a multi-part file.
  std::uint64_t at = kFrame;
  bool first_of_header = true;
  while (true) {
    const auto name = name_of(stream);
    if (name && name->empty()) {
      if ((version & kHasParts) == 0 || first_of_header) return {};
      first_of_header = true;
      ++at;
      continue;
    }
    const auto type = name ? name_of(stream) : std::nullopt;
    const auto size = type ? little_endian(stream) : std::nullopt;
    if (!size) return fmt::format("damaged OpenEXR (its header has no end in {} bytes)", bytes);
    at += name->size() + type->size() + 2 + sizeof(*size);
    if (at + *size > bytes)
      return fmt::format(
          "damaged OpenEXR (its header claims {} bytes for '{}', and the file is too small for so many: {})",
          *size, printable(*name, 40), bytes);
    at += *size;
    stream.seekg(static_cast<std::streamoff>(at));
    first_of_header = false;
  }
}

}  // namespace fusebench::images
