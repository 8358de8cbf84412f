#include "datasets/plain_png.hpp"

#include <libdeflate.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace fusebench {

namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t kHeaderBytes = 13;

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<std::uint8_t>(c);
  return value;
}

/// Empty if it cannot be read; folders and devices have no content of a known size.
std::string content_of(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return {};
  std::string content(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(content.data(), static_cast<std::streamsize>(size))) return {};
  return content;
}

struct Chunk {
  std::string_view type;
  std::string_view data;
};

/// Takes the first chunk off; none if it is cut short or its checksum is wrong. A chunk: length of its data,
/// four letters of its type, data, checksum of type and data.
std::optional<Chunk> take_chunk(std::string_view& rest) {
  constexpr std::size_t kFrame = 12;
  if (rest.size() < kFrame) return std::nullopt;
  const std::size_t length = big_endian(rest);
  if (rest.size() - kFrame < length) return std::nullopt;
  if (libdeflate_crc32(0, rest.data() + 4, 4 + length) != big_endian(rest.substr(8 + length)))
    return std::nullopt;
  const Chunk chunk{rest.substr(4, 4), rest.substr(8, length)};
  rest.remove_prefix(kFrame + length);
  return chunk;
}

/// Everything between signature and end.
struct Chunks {
  std::string_view header;
  std::string pixels;  ///< compressed
};

std::optional<Chunks> read_chunks(std::string_view rest) {
  if (!rest.starts_with(kSignature)) return std::nullopt;
  rest.remove_prefix(kSignature.size());
  const std::optional<Chunk> first = take_chunk(rest);
  if (!first || first->type != "IHDR" || first->data.size() != kHeaderBytes) return std::nullopt;
  Chunks chunks{first->data, {}};
  chunks.pixels.reserve(rest.size());
  bool after_pixels = false;  // they must not be interrupted
  while (const std::optional<Chunk> chunk = take_chunk(rest)) {
    if (chunk->type == "IEND") return chunks;
    if (chunk->type == "IDAT") {
      if (after_pixels) return std::nullopt;
      chunks.pixels += chunk->data;
      continue;
    }
    after_pixels = !chunks.pixels.empty();
    // A small first letter: readers may pass over it; all do, but for transparency.
    const bool ancillary = (chunk->type[0] & 0x20) != 0;
    if (!ancillary || chunk->type == "tRNS") return std::nullopt;
  }
  return std::nullopt;
}

/// Rows of samples, each behind the number of its filter.
struct FilteredRows {
  std::size_t height = 0;
  std::size_t row_bytes = 0;
  std::unique_ptr<std::uint8_t[]> bytes;

  [[nodiscard]] std::uint8_t* row(std::size_t y) { return bytes.get() + y * (row_bytes + 1) + 1; }
  [[nodiscard]] std::uint8_t filter(std::size_t y) { return row(y)[-1]; }
};

std::optional<FilteredRows> inflate(const Chunks& chunks, std::size_t height, std::size_t row_bytes) {
  // A header may claim any size, but one byte makes at most 1032.
  constexpr std::size_t kMostPerByte = 1032;
  const std::size_t size = height * (row_bytes + 1);
  if (size / kMostPerByte > chunks.pixels.size()) return std::nullopt;
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
      libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  FilteredRows rows{height, row_bytes, std::make_unique_for_overwrite<std::uint8_t[]>(size)};
  // Without a place for the size, exactly this much is a success.
  const bool complete = decompressor && libdeflate_zlib_decompress(decompressor.get(), chunks.pixels.data(),
                                                                   chunks.pixels.size(), rows.bytes.get(),
                                                                   size, nullptr) == LIBDEFLATE_SUCCESS;
  return complete ? std::optional(std::move(rows)) : std::nullopt;
}

/// Of left, above and above left, the one that is closest to left + above - above left.
int paeth(int left, int above, int corner) {
  const int by_left = std::abs(above - corner);
  const int by_above = std::abs(left - corner);
  const int by_corner = std::abs(left + above - 2 * corner);
  const int upper = by_above <= by_corner ? above : corner;
  return by_left <= by_above && by_left <= by_corner ? left : upper;
}

/// Undoes the filter of a row: every sample was stored less what `predict(left, above, corner)` says.
template <std::size_t kPixelBytes, class Predict>
void add_prediction(std::uint8_t* row, const std::uint8_t* above, std::size_t row_bytes,
                    const Predict& predict) {
  std::array<std::uint8_t, kPixelBytes> left{};
  std::array<std::uint8_t, kPixelBytes> corner{};
  for (std::size_t begin = 0; begin < row_bytes; begin += kPixelBytes) {
    for (std::size_t i = 0; i < kPixelBytes; ++i) {
      const std::uint8_t up = above[begin + i];
      left[i] = static_cast<std::uint8_t>(row[begin + i] + predict(left[i], up, corner[i]));
      corner[i] = up;
      row[begin + i] = left[i];
    }
  }
}

/// False if there is no such filter. above: the row before, zeros for the first.
template <std::size_t kPixelBytes>
bool unfilter(int filter, std::uint8_t* row, const std::uint8_t* above, std::size_t row_bytes) {
  switch (filter) {
    case 0:
      return true;
    case 1:
      add_prediction<kPixelBytes>(row, above, row_bytes, [](int left, int, int) { return left; });
      return true;
    case 2:
      for (std::size_t i = 0; i < row_bytes; ++i) row[i] = static_cast<std::uint8_t>(row[i] + above[i]);
      return true;
    case 3:
      add_prediction<kPixelBytes>(row, above, row_bytes,
                                  [](int left, int up, int) { return (left + up) / 2; });
      return true;
    case 4:
      add_prediction<kPixelBytes>(row, above, row_bytes, paeth);
      return true;
    default:
      return false;
  }
}

void store(const std::uint8_t* samples, Rgb* row, std::size_t row_bytes) {
  std::memcpy(row, samples, row_bytes);
}

void store(const std::uint8_t* samples, std::uint16_t* row, std::size_t row_bytes) {
  for (std::size_t i = 0; i < row_bytes / 2; ++i) {
    row[i] = static_cast<std::uint16_t>(samples[2 * i] << 8 | samples[2 * i + 1]);
  }
}

/// layout: bits a sample, kind of colour, compression, filtering, interlacing, as in the header.
template <class Pixel>
std::optional<Image<Pixel>> read_plain_png(const std::filesystem::path& file, std::string_view layout) {
  const std::string content = content_of(file);
  const std::optional<Chunks> chunks = read_chunks(content);
  if (!chunks || chunks->header.substr(8) != layout) return std::nullopt;
  const std::uint32_t width = big_endian(chunks->header);
  const std::uint32_t height = big_endian(chunks->header.substr(4));
  constexpr std::uint32_t kMostSide = 1U << 20;
  if (width == 0 || height == 0 || width > kMostSide || height > kMostSide) return std::nullopt;
  std::optional<FilteredRows> rows = inflate(*chunks, height, width * sizeof(Pixel));
  if (!rows) return std::nullopt;
  Image<Pixel> image(static_cast<int>(width), static_cast<int>(height));
  const std::vector<std::uint8_t> nothing(rows->row_bytes, 0);
  for (std::size_t y = 0; y < rows->height; ++y) {
    const std::uint8_t* above = y > 0 ? rows->row(y - 1) : nothing.data();
    if (!unfilter<sizeof(Pixel)>(rows->filter(y), rows->row(y), above, rows->row_bytes)) return std::nullopt;
    store(rows->row(y), &image.data[y * width], rows->row_bytes);
  }
  return image;
}

}  // namespace

std::optional<ColorImage> read_plain_png_color(const std::filesystem::path& file) {
  return read_plain_png<Rgb>(file, {"\x08\x02\x00\x00\x00", 5});
}

std::optional<Image<std::uint16_t>> read_plain_png_grey16(const std::filesystem::path& file) {
  return read_plain_png<std::uint16_t>(file, {"\x10\x00\x00\x00\x00", 5});
}

}  // namespace fusebench
