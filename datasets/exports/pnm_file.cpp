#include "datasets/exports/pnm_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <string_view>
#include <system_error>

#include "datasets/images/file_content.hpp"

namespace fusebench::exports {

namespace {

constexpr int kMostPixelsASide = 65535;

/// A file's header is taken off its bytes.
struct PnmContent {
  int width_px = 0;
  int height_px = 0;
  std::string_view pixels;
};

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The next word of the header; comments run from '#' to the end of the line.
std::string_view take_word(std::string_view& rest) {
  while (!rest.empty() && (is_space(rest.front()) || rest.front() == '#')) {
    const std::size_t end = rest.front() == '#' ? rest.find('\n') : 1;
    rest.remove_prefix(std::min(end, rest.size()));
  }
  std::size_t length = 0;
  while (length < rest.size() && !is_space(rest[length])) ++length;
  const std::string_view word = rest.substr(0, length);
  rest.remove_prefix(length);
  return word;
}

/// 0 if it is no positive number that an image can have.
int positive(std::string_view word) {
  int value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc{} && end == word.data() + word.size();
  return whole && value > 0 && value <= kMostPixelsASide ? value : 0;
}

Result<PnmContent> split(const std::filesystem::path& file, std::string_view content, std::string_view kind,
                         int most_value, std::size_t pixel_bytes) {
  const auto corrupt = [&](std::string_view what) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: {}; expected {} with values up to {}",
                                                     file.string(), what, kind, most_value));
  };
  if (take_word(content) != kind) return corrupt("another kind of file");
  PnmContent result;
  result.width_px = positive(take_word(content));
  result.height_px = positive(take_word(content));
  if (result.width_px == 0 || result.height_px == 0) return corrupt("no width and height in its header");
  if (positive(take_word(content)) != most_value) return corrupt("another range of values");
  if (!content.empty()) content.remove_prefix(1);  // one white space before the pixels
  const std::size_t expected =
      static_cast<std::size_t>(result.width_px) * static_cast<std::size_t>(result.height_px) * pixel_bytes;
  if (content.size() < expected)
    return corrupt(fmt::format("{} bytes of pixels instead of {}", content.size(), expected));
  result.pixels = content.substr(0, expected);
  return result;
}

Result<images::ByteBuffer> content(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    return fail(ErrorCode::data_missing, fmt::format("{}: no such image", file.string()));
  return images::content_of(file);
}

}  // namespace

std::string ppm_bytes(const ColorImage& image) {
  std::string bytes = fmt::format("P6\n{} {}\n255\n", image.width, image.height);
  bytes.append(reinterpret_cast<const char*>(image.data.data()), image.data.size() * sizeof(Rgb));
  return bytes;
}

std::string pgm_bytes(const Image<std::uint16_t>& image) {
  std::string bytes = fmt::format("P5\n{} {}\n65535\n", image.width, image.height);
  bytes.reserve(bytes.size() + 2 * image.data.size());
  for (const std::uint16_t value : image.data) {
    bytes += static_cast<char>(value >> 8);
    bytes += static_cast<char>(value & 0xFF);
  }
  return bytes;
}

Result<ColorImage> read_ppm(const std::filesystem::path& file) {
  const auto buffer = content(file);
  if (!buffer) return tl::unexpected(buffer.error());
  const auto read = split(file, buffer->text(), "P6", 255, sizeof(Rgb));
  if (!read) return tl::unexpected(read.error());
  ColorImage image(read->width_px, read->height_px);
  std::memcpy(image.data.data(), read->pixels.data(), read->pixels.size());
  return image;
}

Result<Image<std::uint16_t>> read_pgm(const std::filesystem::path& file) {
  const auto buffer = content(file);
  if (!buffer) return tl::unexpected(buffer.error());
  const auto read = split(file, buffer->text(), "P5", 65535, sizeof(std::uint16_t));
  if (!read) return tl::unexpected(read.error());
  Image<std::uint16_t> image(read->width_px, read->height_px);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const auto high = static_cast<std::uint8_t>(read->pixels[2 * i]);
    const auto low = static_cast<std::uint8_t>(read->pixels[2 * i + 1]);
    image.data[i] = static_cast<std::uint16_t>(high << 8 | low);
  }
  return image;
}

}  // namespace fusebench::exports
