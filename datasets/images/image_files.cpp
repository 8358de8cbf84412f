#include "datasets/images/image_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/io/input_file.hpp"
#include "datasets/images/exr_check.hpp"
#include "datasets/images/file_content.hpp"
#include "datasets/images/image_library_loader.hpp"
#include "datasets/images/plain_png.hpp"
#include "datasets/images/png_check.hpp"
#include "datasets/images/png_writer.hpp"

namespace fusebench::images {

namespace {

/// Error message of the library in one line.
std::string library_reason(std::string reason) {
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == '.')) reason.pop_back();
  for (char& c : reason) c = c == '\n' ? ' ' : c;
  return reason.empty() ? "no reason given" : reason;
}

tl::unexpected<Error> corrupt(const std::string& image, std::string_view what) {
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", image, what));
}

/// Error of a library that cannot be loaded, with the image that requires it.
tl::unexpected<Error> no_library(const std::string& image, Error error) {
  error.message = fmt::format("{}: {}", image, error.message);
  return tl::unexpected(std::move(error));
}

/// Limit for one image, ten times the size of camera images.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26;

/// Upper bound of the pixel bytes that one byte of a file can encode.
/// - Deflate: 1032 (zlib.net/zlib_tech.html); a PNG of one bit with a palette has one bit for three bytes.
/// - JPEG: at least one bit for a block of 64 samples.
/// - OpenEXR: PXR24 drops one of four bytes before it deflates; PIZ encodes 255 equal halves in 9 bits
/// (ImfHuf.cpp); DWAA and DWAB deflate data that is already compressed by 64: runs of 128 bytes in two, or 64
/// samples as a coefficient and a mark (ImfDwaCompressor.cpp). Other methods compress less.
std::uint64_t most_per_byte(const ImageHeader& header) {
  constexpr std::uint64_t kDeflate = 1032;
  if (header.compression.starts_with("dwa")) return 64 * kDeflate;
  return header.type == SampleType::float32 ? 4 * kDeflate / 3 : 24 * kDeflate;
}

/// A header may claim any size. Memory is limited in proportion to the file size; images of a single colour
/// can have tiny files, so smaller sizes are allowed up to the other limit.
Result<void> check_claim(const std::string& image, const ImageHeader& header, std::uintmax_t bytes) {
  const auto width = static_cast<std::uint64_t>(std::max(header.width_px, 0));
  const auto height = static_cast<std::uint64_t>(std::max(header.height_px, 0));
  if (width * height > kMostPixels) {
    return corrupt(image, fmt::format("its header claims {}x{} pixels (allowed: up to {} of them)",
                                      header.width_px, header.height_px, kMostPixels));
  }
  if (header.stored_bytes / most_per_byte(header) <= bytes) return {};
  return corrupt(image, fmt::format("damaged image (its header claims {}x{} pixels, and its {} bytes are too "
                                    "few for so many)",
                                    header.width_px, header.height_px, bytes));
}

/// The library detects the format from the content, not the name. When opening a GIF, it allocates the whole
/// image, and a header of a few bytes may claim 17 GB.
Result<void> check_kind(const std::filesystem::path& file) {
  std::string beginning(4, '\0');
  io::input_file(file).read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  if (beginning != "GIF8") return {};
  return corrupt(file.string(), "a GIF (images are PNG, JPEG or OpenEXR)");
}

Result<OpenedImage> sound_image(const std::string& image, LibraryResult<OpenedImage> opened,
                                std::uintmax_t bytes) {
  if (!opened) return corrupt(image, fmt::format("unreadable image: {}", library_reason(opened.error())));
  if (const auto sound = check_claim(image, opened->header, bytes); !sound)
    return tl::unexpected(sound.error());
  return std::move(*opened);
}

Result<OpenedImage> open_image(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no such image", file.string()));
  }
  if (const auto sized = check_image_bytes(file); !sized) return tl::unexpected(sized.error());
  if (const auto known = check_kind(file); !known) return tl::unexpected(known.error());
  if (const std::string damage = png_damage(file); !damage.empty()) return corrupt(file.string(), damage);
  if (const std::string damage = exr_damage(file); !damage.empty()) return corrupt(file.string(), damage);
  const Result<const ImageLibrary*>& library = image_library();
  if (!library) return no_library(file.string(), library.error());
  return sound_image(file.string(), (*library)->open(file.string()),
                     std::filesystem::file_size(file, ignored));
}

/// The bytes must outlive the image.
Result<OpenedImage> open_bytes(const std::string& name, std::string_view bytes) {
  const Result<const ImageLibrary*>& library = image_library();
  if (!library) return no_library(name, library.error());
  const bool is_png = bytes.starts_with("\x89PNG");
  return sound_image(name,
                     (*library)->open_bytes(is_png ? "memory.png" : "memory.jpg",
                                            std::as_bytes(std::span(bytes.data(), bytes.size()))),
                     bytes.size());
}

/// Required format of the file.
struct Layout {
  int channels = 0;
  SampleType type = SampleType::uint8;
  std::string_view name;
};

tl::unexpected<Error> damaged_pixels(const std::string& image, const std::string& reason) {
  return corrupt(image, fmt::format("truncated or damaged image: {}", library_reason(reason)));
}

Result<void> check_size(const std::string& image, const ImageHeader& header,
                        std::optional<ImageSize> expected) {
  if (!expected || *expected == ImageSize{header.width_px, header.height_px}) return {};
  return corrupt(image, fmt::format("expected {}x{} pixels, got {}x{}", expected->width_px,
                                    expected->height_px, header.width_px, header.height_px));
}

template <class Pixel>
Result<Image<Pixel>> pixels_of(const std::string& name, const OpenedImage& opened, const Layout& layout,
                               std::optional<ImageSize> expected) {
  const ImageHeader& header = opened.header;
  if (header.channels != layout.channels || header.type != layout.type) {
    return corrupt(name, fmt::format("expected {}, got {} channel(s) of {}", layout.name, header.channels,
                                     header.type_name));
  }
  if (const auto fits = check_size(name, header, expected); !fits) return tl::unexpected(fits.error());
  Image<Pixel> image(header.width_px, header.height_px);
  if (const auto read = opened.read_pixels(layout.channels, std::as_writable_bytes(std::span(image.data)));
      !read)
    return damaged_pixels(name, read.error());
  return image;
}

/// Reads the pixels of an opened image.
template <class Pixel>
using PixelReader = Result<Image<Pixel>> (*)(const std::string& name, const OpenedImage& opened,
                                             std::optional<ImageSize> expected);

Result<GreyImage> grey_pixels(const std::string& name, const OpenedImage& opened,
                              std::optional<ImageSize> expected) {
  return pixels_of<std::uint8_t>(name, opened, {1, SampleType::uint8, "a grey image with 8 bits"}, expected);
}

Result<Image<std::uint16_t>> depth_pixels(const std::string& name, const OpenedImage& opened,
                                          std::optional<ImageSize> expected) {
  return pixels_of<std::uint16_t>(name, opened, {1, SampleType::uint16, "a grey image with 16 bits"},
                                  expected);
}

std::uint8_t eight_bits(std::uint8_t sample) { return sample; }

/// round(255 sample / 65535)
std::uint8_t eight_bits(std::uint16_t sample) { return static_cast<std::uint8_t>((sample + 128U) / 257U); }

/// Copies red, green and blue, or grey to all three. Alpha, the last of two or four channels, is ignored.
template <class Sample>
Result<ColorImage> color_from(const std::string& name, const OpenedImage& opened) {
  const std::size_t channels = opened.header.channels < 3 ? 1 : 3;
  ColorImage color(opened.header.width_px, opened.header.height_px);
  std::vector<Sample> samples(channels * color.data.size());
  if (const auto read =
          opened.read_pixels(static_cast<int>(channels), std::as_writable_bytes(std::span(samples)));
      !read)
    return damaged_pixels(name, read.error());
  for (std::size_t i = 0; i < color.data.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      color.data[i][c] = eight_bits(samples[channels * i + (channels == 1 ? 0 : c)]);
  }
  return color;
}

Result<ColorImage> color_pixels(const std::string& name, const OpenedImage& opened,
                                std::optional<ImageSize> expected) {
  const ImageHeader& header = opened.header;
  const bool sampled = header.type == SampleType::uint8 || header.type == SampleType::uint16;
  if (!sampled || header.channels < 1 || header.channels > 4) {
    return corrupt(name, fmt::format("expected a colour or grey image with 8 or 16 bits a channel, got {} "
                                     "channel(s) of {}",
                                     header.channels, header.type_name));
  }
  if (const auto fits = check_size(name, header, expected); !fits) return tl::unexpected(fits.error());
  return header.type == SampleType::uint8 ? color_from<std::uint8_t>(name, opened)
                                          : color_from<std::uint16_t>(name, opened);
}

/// A missing file is reported by the library.
Result<void> check_file_unchanged(const std::filesystem::path& file,
                                  const std::optional<io::ContentHash>& opened) {
  std::error_code ignored;
  if (!opened || !std::filesystem::exists(file, ignored)) return {};
  return check_unchanged(file, content_of(file).text(), opened);
}

/// True if the size is valid and equal to the expected one. Otherwise only the header is passed to the
/// library, which reports the reason.
bool has_usual_size(std::string_view bytes, std::optional<ImageSize> expected) {
  const std::optional<ClaimedSize> claim = png_claim(bytes);
  if (!claim) return true;
  const auto side = [](int px) { return static_cast<std::uint32_t>(px); };
  if (expected &&
      (side(expected->width_px) != claim->width_px || side(expected->height_px) != claim->height_px))
    return false;
  return std::uint64_t{claim->width_px} * claim->height_px <= kMostPixels;
}

template <class Pixel, class Decode>
Result<Image<Pixel>> decode_image(const Decode& decode_plain, const std::string& name, std::string_view bytes,
                                  PixelReader<Pixel> pixels) {
  if (has_usual_size(bytes, std::nullopt)) {
    ByteBuffer content(bytes.size());
    std::ranges::copy(bytes, content.bytes.get());
    if (auto plain = decode_plain(std::move(content))) return std::move(*plain);
  }
  const auto opened = open_bytes(name, bytes);
  if (!opened) return tl::unexpected(opened.error());
  return pixels(name, *opened, std::nullopt);
}

/// Plain PNGs use the fast decoder. All other and all damaged files are passed to the library, which reports
/// the reason.
template <class Pixel, class Decode>
Result<Image<Pixel>> plain_or_any(const Decode& decode_plain, const std::filesystem::path& file,
                                  PixelReader<Pixel> pixels, std::optional<ImageSize> expected,
                                  const std::optional<io::ContentHash>& opened) {
  if (const auto sized = check_image_bytes(file); !sized) return tl::unexpected(sized.error());
  ByteBuffer content = content_of(file);
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {  // otherwise the error is the missing library
    if (const auto same = check_unchanged(file, content.text(), opened); !same)
      return tl::unexpected(same.error());
  }
  std::optional<Image<Pixel>> plain;
  if (has_usual_size(content.text(), expected)) plain = decode_plain(std::move(content));
  if (plain) return std::move(*plain);
  const auto image = open_image(file);
  if (!image) return tl::unexpected(image.error());
  return pixels(file.string(), *image, expected);
}

template <class Pixel>
PixelView view_of(const Image<Pixel>& image, int channels, SampleType type) {
  return {image.width, image.height, channels, type, std::as_bytes(std::span(image.data))};
}

Result<void> write_image(const std::filesystem::path& file, const PixelView& image) {
  const auto written = write_png_file(file, image);
  if (written) return {};
  return fail(ErrorCode::io,
              fmt::format("{}: cannot be written: {}", file.string(), library_reason(written.error())));
}

}  // namespace

Result<ImageSize> read_image_size(const std::filesystem::path& file) {
  // Decoding a plain PNG is faster than loading the library.
  ByteBuffer content = content_of(file);
  if (has_usual_size(content.text(), std::nullopt)) {
    if (const auto plain = decode_plain_png_color(std::move(content)))
      return ImageSize{plain->width, plain->height};
  }
  const auto opened = open_image(file);
  if (!opened) return tl::unexpected(opened.error());
  return ImageSize{opened->header.width_px, opened->header.height_px};
}

std::optional<ImageSize> png_size(std::string_view bytes) {
  const std::optional<ClaimedSize> claim = png_claim(bytes);
  if (!claim) return std::nullopt;
  const std::uint64_t pixels = std::uint64_t{claim->width_px} * claim->height_px;
  if (pixels == 0 || pixels > kMostPixels) return std::nullopt;
  return ImageSize{static_cast<int>(claim->width_px), static_cast<int>(claim->height_px)};
}

Result<ColorImage> read_color(const std::filesystem::path& file, std::optional<ImageSize> expected,
                              const std::optional<io::ContentHash>& opened) {
  return plain_or_any<Rgb>(decode_plain_png_color, file, color_pixels, expected, opened);
}

Result<GreyImage> read_grey(const std::filesystem::path& file, std::optional<ImageSize> expected) {
  const auto image = open_image(file);
  if (!image) return tl::unexpected(image.error());
  return grey_pixels(file.string(), *image, expected);
}

Result<Image<std::uint16_t>> read_depth16(const std::filesystem::path& file,
                                          std::optional<ImageSize> expected,
                                          const std::optional<io::ContentHash>& opened) {
  return plain_or_any<std::uint16_t>(decode_plain_png_grey16, file, depth_pixels, expected, opened);
}

Result<Image<float>> read_float(const std::filesystem::path& file, std::optional<ImageSize> expected,
                                const std::optional<io::ContentHash>& opened) {
  if (const auto same = check_file_unchanged(file, opened); !same) return tl::unexpected(same.error());
  const auto image = open_image(file);
  if (!image) return tl::unexpected(image.error());
  const ImageHeader& header = image->header;
  if (header.type != SampleType::float32 || header.channels < 1) {
    return corrupt(file.string(),
                   fmt::format("expected an image of floating-point numbers, got {} channel(s) of {}",
                               header.channels, header.type_name));
  }
  if (const auto fits = check_size(file.string(), header, expected); !fits)
    return tl::unexpected(fits.error());
  Image<float> first(header.width_px, header.height_px);
  if (const auto read = image->read_pixels(1, std::as_writable_bytes(std::span(first.data))); !read)
    return damaged_pixels(file.string(), read.error());
  return first;
}

Result<ColorImage> decode_color(const std::string& name, std::string_view bytes) {
  return decode_image<Rgb>(decode_plain_png_color, name, bytes, color_pixels);
}

Result<Image<std::uint16_t>> decode_depth16(const std::string& name, std::string_view bytes) {
  return decode_image<std::uint16_t>(decode_plain_png_grey16, name, bytes, depth_pixels);
}

Result<std::vector<std::uint8_t>> encode_png(const ColorImage& image) {
  std::vector<std::uint8_t> bytes = png_bytes(view_of(image, 3, SampleType::uint8));
  if (bytes.empty()) return fail(ErrorCode::io, "PNG in memory: not enough memory");
  return bytes;
}

Result<void> write_png(const std::filesystem::path& file, const ColorImage& image) {
  return write_image(file, view_of(image, 3, SampleType::uint8));
}

Result<void> write_png(const std::filesystem::path& file, const GreyImage& image) {
  return write_image(file, view_of(image, 1, SampleType::uint8));
}

Result<void> write_png(const std::filesystem::path& file, const Image<std::uint16_t>& image) {
  return write_image(file, view_of(image, 1, SampleType::uint16));
}

Result<std::vector<std::uint8_t>> encode_jpeg(const ColorImage& image, int quality) {
  constexpr const char* kWhat = "JPEG in memory";
  const Result<const ImageLibrary*>& library = image_library();
  if (!library) return no_library(kWhat, library.error());
  auto bytes = (*library)->encode_jpeg(view_of(image, 3, SampleType::uint8), quality);
  if (!bytes) return fail(ErrorCode::io, fmt::format("{}: {}", kWhat, library_reason(bytes.error())));
  return std::move(*bytes);
}

}  // namespace fusebench::images
