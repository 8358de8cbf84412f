#include "datasets/recording/formats/rosbag/lz4_frame.hpp"

#include <cstdint>

namespace fusebench::formats::rosbag {

namespace {

constexpr std::uint32_t kFrameMagic = 0x184D2204;
constexpr std::uint32_t kStoredBlock = 0x80000000;
constexpr std::size_t kShortestMatch = 4;
constexpr std::size_t kLongToken = 15;

/// Takes bytes from the front; after the first that is not there, every answer is zero or empty.
class Input {
 public:
  explicit Input(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

  std::string_view take(std::size_t count) {
    if (count > bytes_.size()) {
      failed_ = true;
      bytes_ = {};
      return {};
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  std::size_t byte() {
    const std::string_view taken = take(1);
    return taken.empty() ? 0 : static_cast<unsigned char>(taken.front());
  }
  std::uint32_t number() {
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < 32; shift += 8) value |= static_cast<std::uint32_t>(byte()) << shift;
    return value;
  }

 private:
  std::string_view bytes_;
  bool failed_ = false;
};

/// A length of four bits, which goes on in bytes of 255.
std::size_t length(Input& input, std::size_t bits) {
  std::size_t value = bits;
  for (std::size_t more = bits == kLongToken ? 255 : 0; more == 255 && !input.failed(); value += more)
    more = input.byte();
  return value;
}

/// Appends the content of a block, which may refer to what is there already. False: damaged.
bool append_block(std::string_view block, std::size_t most, std::string& content) {
  Input input(block);
  while (input.left() > 0) {
    const std::size_t token = input.byte();
    const std::string_view literals = input.take(length(input, token >> 4));
    if (input.failed() || literals.size() > most - content.size()) return false;
    content += literals;
    if (input.left() == 0) return true;  // the last sequence has no match
    const std::size_t low = input.byte();
    const std::size_t offset = low | input.byte() << 8;
    const std::size_t count = length(input, token & kLongToken) + kShortestMatch;
    if (input.failed() || offset == 0 || offset > content.size() || count > most - content.size())
      return false;
    // A match may overlap what it makes: byte after byte.
    for (std::size_t i = 0, from = content.size() - offset; i < count; ++i) content += content[from + i];
  }
  return true;
}

}  // namespace

std::optional<std::string> lz4_content(std::string_view frame, std::size_t size) {
  Input input(frame);
  if (input.number() != kFrameMagic) return std::nullopt;
  const std::size_t flags = input.byte();
  const bool has_block_checksum = (flags & 0x10) != 0;
  const bool has_content_size = (flags & 0x08) != 0;
  const bool has_dictionary = (flags & 0x01) != 0;
  if (flags >> 6 != 1 || has_dictionary) return std::nullopt;
  input.take(has_content_size ? 1 + 8 + 1 : 1 + 1);  // block size, content size, checksum of the header
  // A byte of a frame makes at most 255 of content; a claim beyond is damage, and not allocated.
  if (size / 255 > frame.size()) return std::nullopt;
  std::string content;
  content.reserve(size);
  while (!input.failed()) {
    const std::uint32_t block_size = input.number();
    if (block_size == 0) break;
    const std::string_view block = input.take(block_size & ~kStoredBlock);
    if (has_block_checksum) input.take(4);
    if (input.failed()) break;
    if ((block_size & kStoredBlock) == 0) {
      if (!append_block(block, size, content)) return std::nullopt;
    } else {
      if (block.size() > size - content.size()) return std::nullopt;
      content += block;
    }
  }
  if (input.failed() || content.size() != size) return std::nullopt;
  return content;
}

}  // namespace fusebench::formats::rosbag
