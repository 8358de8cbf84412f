#include "datasets/images/png_writer.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace fusebench::images {

namespace {

// Fastest level: 8 ms for a noisy colour image of 640x480 pixels, and 1 % fewer bytes than level 2, since
// noise has few repetitions.
constexpr int kCompressionLevel = 1;
constexpr std::uint8_t kFilterSub = 1;

using Bytes = std::vector<std::uint8_t>;

void append_number(std::uint32_t value, Bytes& bytes) {
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// Length, type, content and checksum (PNG specification, 5.3).
void append_chunk(std::string_view type, std::span<const std::uint8_t> content, Bytes& file) {
  append_number(static_cast<std::uint32_t>(content.size()), file);
  const std::size_t begin = file.size();
  file.insert(file.end(), type.begin(), type.end());
  file.insert(file.end(), content.begin(), content.end());
  append_number(libdeflate_crc32(0, file.data() + begin, file.size() - begin), file);
}

/// Width, height, bits per sample, colour type; compression, filter and interlace methods are 0.
Bytes header_of(const PixelView& image) {
  constexpr std::uint8_t kGreyType = 0;
  constexpr std::uint8_t kColorType = 2;
  Bytes header;
  append_number(static_cast<std::uint32_t>(image.width_px), header);
  append_number(static_cast<std::uint32_t>(image.height_px), header);
  header.push_back(image.type == SampleType::uint16 ? 16 : 8);
  header.push_back(image.channels == 3 ? kColorType : kGreyType);
  header.insert(header.end(), 3, 0);
  return header;
}

/// Rows in the byte order of the file, each after its filter type: differences to the previous pixel
/// (specification, 9.2).
Bytes filtered_rows(const PixelView& image) {
  const bool wide = image.type == SampleType::uint16;
  const std::size_t pixel_bytes = static_cast<std::size_t>(image.channels) * (wide ? 2 : 1);
  const std::size_t row_bytes = pixel_bytes * static_cast<std::size_t>(image.width_px);
  const auto rows = static_cast<std::size_t>(image.height_px);
  const bool swap = wide && std::endian::native == std::endian::little;
  Bytes row(row_bytes);
  Bytes filtered(rows * (row_bytes + 1));
  for (std::size_t y = 0; y < rows; ++y) {
    std::memcpy(row.data(), image.pixels.data() + y * row_bytes, row_bytes);
    for (std::size_t i = 0; swap && i + 1 < row_bytes; i += 2) std::swap(row[i], row[i + 1]);
    std::uint8_t* out = filtered.data() + y * (row_bytes + 1);
    *out++ = kFilterSub;
    std::copy_n(row.data(), std::min(pixel_bytes, row_bytes), out);
    for (std::size_t i = pixel_bytes; i < row_bytes; ++i)
      out[i] = static_cast<std::uint8_t>(row[i] - row[i - pixel_bytes]);
  }
  return filtered;
}

/// Compresses to the zlib format. Empty if memory is exhausted.
Bytes compressed(const Bytes& content) {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(kCompressionLevel), libdeflate_free_compressor);
  if (!compressor) return {};
  Bytes result(libdeflate_zlib_compress_bound(compressor.get(), content.size()));
  result.resize(libdeflate_zlib_compress(compressor.get(), content.data(), content.size(), result.data(),
                                         result.size()));
  return result;
}

}  // namespace

std::vector<std::uint8_t> png_bytes(const PixelView& image) {
  const Bytes pixels = compressed(filtered_rows(image));
  if (pixels.empty()) return {};
  Bytes bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  append_chunk("IHDR", header_of(image), bytes);
  append_chunk("IDAT", pixels, bytes);
  append_chunk("IEND", {}, bytes);
  return bytes;
}

tl::expected<void, std::string> write_png_file(const std::filesystem::path& file, const PixelView& image) {
  const Bytes bytes = png_bytes(image);
  if (bytes.empty()) return tl::unexpected(std::string("not enough memory"));
  const auto reason_of_system = [] { return tl::unexpected(std::string(std::strerror(errno))); };
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> output(std::fopen(file.c_str(), "wb"), std::fclose);
  if (!output) return reason_of_system();
  if (std::fwrite(bytes.data(), 1, bytes.size(), output.get()) != bytes.size()) return reason_of_system();
  if (std::fclose(output.release()) != 0) return reason_of_system();
  return {};
}

}  // namespace fusebench::images
