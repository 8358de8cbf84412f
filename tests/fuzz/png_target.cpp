// The check of PNG files that runs before a decoder sees them.
#include <zlib.h>

#include <cstdint>
#include <string>

#include "core/base/error.hpp"
#include "datasets/images/png_check.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace images;

namespace {

constexpr std::size_t kSignature = 8;
constexpr std::size_t kFrame = 12;  // length, type and checksum of a chunk

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<std::uint8_t>(c);
  return value;
}

/// Gives every whole chunk the checksum that it should have. Mutations hardly ever hit one.
std::string with_right_checksums(std::string_view bytes) {
  std::string repaired(bytes);
  for (std::size_t at = kSignature; at + kFrame <= repaired.size();) {
    const std::size_t length = big_endian(std::string_view(repaired).substr(at));
    if (length > repaired.size() - at - kFrame) break;
    const auto* covered = reinterpret_cast<const unsigned char*>(repaired.data() + at + 4);
    const auto sum = static_cast<std::uint32_t>(crc32_z(0, covered, length + 4));
    for (std::size_t i = 0; i < 4; ++i)
      repaired[at + 8 + length + i] = static_cast<char>(sum >> (24 - 8 * i));
    at += kFrame + length;
  }
  return repaired;
}

}  // namespace

void png(std::string_view bytes) {
  static const MemoryFile file("image.png");
  file.write(bytes);
  const std::string damage = png_damage(file.path());
  check(damage.empty() || damage.starts_with("truncated PNG") || damage.starts_with("damaged PNG"),
        "damage has a name");
  const std::string repaired = with_right_checksums(bytes);
  file.write(repaired);
  const std::string rest = png_damage(file.path());
  check(rest.empty() || rest.starts_with("truncated PNG"), "right checksums are no damage");
  check(!damage.empty() || rest.empty(), "a sound file stays sound");
  check(!rest.empty() || bytes.size() < kSignature || repaired.find("IEND") != repaired.npos ||
            !bytes.starts_with("\x89PNG\r\n\x1a\n"),
        "a whole PNG has an end");
}

}  // namespace fusebench::fuzz
