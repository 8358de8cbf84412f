#include "datasets/images/plain_png.hpp"

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "datasets/images/png_filters.hpp"

namespace fusebench::images {

namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t kHeaderBytes = 13;

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<std::uint8_t>(c);
  return value;
}

/// CRC-32 of PNG and gzip.
std::uint32_t checksum(std::string_view bytes) {
  return crc32_gzip_refl(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

struct Chunk {
  std::string_view type;
  std::string_view data;
};

/// Removes and returns the first chunk; nothing if it is truncated or its checksum is wrong. Layout: data
/// length, four letters of the type, data, checksum of type and data.
std::optional<Chunk> take_chunk(std::string_view& rest) {
  constexpr std::size_t kFrame = 12;
  if (rest.size() < kFrame) return std::nullopt;
  const std::size_t length = big_endian(rest);
  if (rest.size() - kFrame < length) return std::nullopt;
  if (checksum(rest.substr(4, 4 + length)) != big_endian(rest.substr(8 + length))) return std::nullopt;
  const Chunk chunk{rest.substr(4, 4), rest.substr(8, length)};
  rest.remove_prefix(kFrame + length);
  return chunk;
}

/// The chunks between signature and end.
struct Chunks {
  std::string_view header;
  std::span<std::uint8_t> pixels;  ///< compressed
};

/// Appends the data of a chunk, which is at a later position of the same content, to the joined data.
void join(std::string_view data, ByteBuffer& content, std::span<std::uint8_t>& joined) {
  const auto at = static_cast<std::size_t>(data.data() - content.text().data());
  std::uint8_t* const begin = joined.empty() ? &content.bytes[at] : joined.data();
  std::memmove(begin + joined.size(), data.data(), data.size());
  joined = {begin, joined.size() + data.size()};
}

/// Joins the data of all pixel chunks. Overwrites the rest of the content except the header.
std::optional<Chunks> join_chunks(ByteBuffer& content) {
  std::string_view rest = content.text();
  if (!rest.starts_with(kSignature)) return std::nullopt;
  rest.remove_prefix(kSignature.size());
  const std::optional<Chunk> first = take_chunk(rest);
  if (!first || first->type != "IHDR" || first->data.size() != kHeaderBytes) return std::nullopt;
  Chunks chunks{first->data, {}};
  bool after_pixels = false;  // pixel chunks must be consecutive
  while (const std::optional<Chunk> chunk = take_chunk(rest)) {
    if (chunk->type == "IEND") return chunks;
    if (chunk->type == "IDAT") {
      if (after_pixels) return std::nullopt;
      join(chunk->data, content, chunks.pixels);
      continue;
    }
    after_pixels = !chunks.pixels.empty();
    // Ancillary chunks (small first letter) are ignored, except transparency.
    const bool ancillary = (chunk->type[0] & 0x20) != 0;
    if (!ancillary || chunk->type == "tRNS") return std::nullopt;
  }
  return std::nullopt;
}

/// Nothing if the compressed stream is damaged (by its checksum) or has another size.
std::optional<ByteBuffer> inflate(std::span<std::uint8_t> compressed, std::size_t size) {
  // A header may claim any size, but one byte expands to at most 1032.
  constexpr std::size_t kMaxPerByte = 1032;
  // limit of the library's counter
  constexpr std::size_t kMaxBytes = std::numeric_limits<std::uint32_t>::max();
  if (size / kMaxPerByte > compressed.size() || std::max(size, compressed.size()) > kMaxBytes)
    return std::nullopt;
  ByteBuffer inflated(size);
  const auto state = std::make_unique_for_overwrite<inflate_state>();
  isal_inflate_init(state.get());
  state->crc_flag = ISAL_ZLIB;
  state->next_in = compressed.data();
  state->avail_in = static_cast<std::uint32_t>(compressed.size());
  state->next_out = inflated.bytes.get();
  state->avail_out = static_cast<std::uint32_t>(size);
  const bool sound = isal_inflate_stateless(state.get()) == ISAL_DECOMP_OK && state->total_out == size;
  return sound ? std::optional(std::move(inflated)) : std::nullopt;
}

/// rows: each preceded by its filter number. False for an unknown filter.
template <std::size_t kPixelBytes>
bool undo_filters(const ByteBuffer& rows, std::span<std::uint8_t> samples, std::size_t row_bytes) {
  const std::vector<std::uint8_t> nothing(row_bytes, 0);
  std::span<const std::uint8_t> above = nothing;
  const std::uint8_t* filtered = rows.bytes.get();
  for (std::size_t begin = 0; begin < samples.size(); begin += row_bytes) {
    const auto row = samples.subspan(begin, row_bytes);
    if (!undo_png_filter<kPixelBytes>(filtered[0], {filtered + 1, row_bytes}, above, row)) return false;
    above = row;
    filtered += 1 + row_bytes;
  }
  return true;
}

void from_big_endian(std::vector<Rgb>&) {}

void from_big_endian(std::vector<std::uint16_t>& values) {
  for (std::uint16_t& value : values) {
    std::array<std::uint8_t, 2> bytes;
    std::memcpy(bytes.data(), &value, 2);
    value = static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]);
  }
}

/// layout: as in the header: bits per sample, colour type, compression, filtering, interlacing.
template <class Pixel>
std::optional<Image<Pixel>> decode_plain_png(ByteBuffer content, std::string_view layout) {
  const std::optional<Chunks> chunks = join_chunks(content);
  if (!chunks || chunks->header.substr(8) != layout) return std::nullopt;
  const std::uint32_t width = big_endian(chunks->header);
  const std::uint32_t height = big_endian(chunks->header.substr(4));
  constexpr std::uint32_t kMaxSide = 1U << 20;
  if (width == 0 || height == 0 || width > kMaxSide || height > kMaxSide) return std::nullopt;
  const std::size_t row_bytes = width * sizeof(Pixel);
  const std::optional<ByteBuffer> rows = inflate(chunks->pixels, height * (1 + row_bytes));
  if (!rows) return std::nullopt;
  Image<Pixel> image(static_cast<int>(width), static_cast<int>(height));
  const std::span samples(reinterpret_cast<std::uint8_t*>(image.data.data()), height * row_bytes);
  if (!undo_filters<sizeof(Pixel)>(*rows, samples, row_bytes)) return std::nullopt;
  from_big_endian(image.data);
  return image;
}

}  // namespace

std::optional<ColorImage> decode_plain_png_color(ByteBuffer content) {
  return decode_plain_png<Rgb>(std::move(content), {"\x08\x02\x00\x00\x00", 5});
}

std::optional<Image<std::uint16_t>> decode_plain_png_grey16(ByteBuffer content) {
  return decode_plain_png<std::uint16_t>(std::move(content), {"\x10\x00\x00\x00\x00", 5});
}

std::optional<ColorImage> read_plain_png_color(const std::filesystem::path& file) {
  return decode_plain_png_color(content_of(file));
}

std::optional<Image<std::uint16_t>> read_plain_png_grey16(const std::filesystem::path& file) {
  return decode_plain_png_grey16(content_of(file));
}

}  // namespace fusebench::images
