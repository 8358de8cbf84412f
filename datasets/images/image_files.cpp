#include "datasets/images/image_files.hpp"

#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "datasets/images/file_content.hpp"
#include "datasets/images/image_library_loader.hpp"
#include "datasets/images/plain_png.hpp"
#include "datasets/images/png_check.hpp"
#include "datasets/images/png_writer.hpp"

namespace fusebench::images {

namespace {

/// The library's reason in one line.
std::string library_reason(std::string reason) {
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == '.')) reason.pop_back();
  for (char& c : reason) c = c == '\n' ? ' ' : c;
  return reason.empty() ? "no reason given" : reason;
}

tl::unexpected<Error> corrupt(const std::filesystem::path& file, std::string_view what) {
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", file.string(), what));
}

/// The error of a library that cannot be loaded, with what it is needed for.
tl::unexpected<Error> no_library(const std::string& image, Error error) {
  error.message = fmt::format("{}: {}", image, error.message);
  return tl::unexpected(std::move(error));
}

/// A header may claim any size. PNG's compression makes at most 1032 bytes of one, and JPEG's less in
/// practice, so that memory stays in proportion to the file.
Result<void> check_claim(const std::filesystem::path& file, const ImageHeader& header) {
  constexpr std::uintmax_t kMaxPerByte = 1032;
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(file, ignored);
  if (header.pixel_bytes / kMaxPerByte <= bytes) return {};
  return corrupt(file, fmt::format("damaged image (its header claims {}x{} "
                                   "pixels, too many for {} bytes)",
                                   header.width_px, header.height_px, bytes));
}

Result<OpenedImage> open_image(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no such image", file.string()));
  }
  if (const std::string damage = png_damage(file); !damage.empty()) return corrupt(file, damage);
  const Result<const ImageLibrary*>& library = image_library();
  if (!library) return no_library(file.string(), library.error());
  auto opened = (*library)->open(file.string());
  if (!opened) return corrupt(file, fmt::format("unreadable image: {}", library_reason(opened.error())));
  if (const auto sound = check_claim(file, opened->header); !sound) return tl::unexpected(sound.error());
  return std::move(*opened);
}

/// Requirements of the caller on the file.
struct Layout {
  int channels = 0;
  SampleType type = SampleType::uint8;
  std::string_view name;
};

template <class Pixel>
Result<Image<Pixel>> read_image(const std::filesystem::path& file, const Layout& layout,
                                std::optional<ImageSize> expected) {
  const auto opened = open_image(file);
  if (!opened) return tl::unexpected(opened.error());
  const ImageHeader& header = opened->header;
  if (header.channels != layout.channels || header.type != layout.type) {
    return corrupt(file, fmt::format("expected {}, got {} channel(s) of {}", layout.name, header.channels,
                                     header.type_name));
  }
  if (expected && *expected != ImageSize{header.width_px, header.height_px}) {
    return corrupt(file, fmt::format("expected {}x{} pixels, got {}x{}", expected->width_px,
                                     expected->height_px, header.width_px, header.height_px));
  }
  Image<Pixel> image(header.width_px, header.height_px);
  if (const auto read = opened->read_pixels(std::as_writable_bytes(std::span(image.data))); !read)
    return corrupt(file, fmt::format("truncated or damaged image: {}", library_reason(read.error())));
  return image;
}

/// Plain PNGs of recordings take the fast decoder; every other or damaged file is left to the library, which
/// reports the reason.
template <class Pixel, class Decode>
Result<Image<Pixel>> plain_or_any(const Decode& decode_plain, const std::filesystem::path& file,
                                  const Layout& layout, std::optional<ImageSize> expected,
                                  const std::optional<io::ContentHash>& opened) {
  ByteBuffer content = content_of(file);
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {  // else the missing library is the error
    if (const auto same = check_unchanged(file, content.text(), opened); !same)
      return tl::unexpected(same.error());
  }
  std::optional<Image<Pixel>> plain = decode_plain(std::move(content));
  const bool good = plain && (!expected || *expected == ImageSize{plain->width, plain->height});
  return good ? Result<Image<Pixel>>(std::move(*plain)) : read_image<Pixel>(file, layout, expected);
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
  // Decoding a whole plain PNG is less work than loading the library.
  if (const auto plain = read_plain_png_color(file)) return ImageSize{plain->width, plain->height};
  const auto opened = open_image(file);
  if (!opened) return tl::unexpected(opened.error());
  return ImageSize{opened->header.width_px, opened->header.height_px};
}

Result<ColorImage> read_color(const std::filesystem::path& file, std::optional<ImageSize> expected,
                              const std::optional<io::ContentHash>& opened) {
  return plain_or_any<Rgb>(decode_plain_png_color, file,
                           {3, SampleType::uint8, "an RGB image with 8 bits a channel"}, expected, opened);
}

Result<GreyImage> read_grey(const std::filesystem::path& file, std::optional<ImageSize> expected) {
  return read_image<std::uint8_t>(file, {1, SampleType::uint8, "a grey image with 8 bits"}, expected);
}

Result<Image<std::uint16_t>> read_depth16(const std::filesystem::path& file,
                                          std::optional<ImageSize> expected,
                                          const std::optional<io::ContentHash>& opened) {
  return plain_or_any<std::uint16_t>(decode_plain_png_grey16, file,
                                     {1, SampleType::uint16, "a grey image with 16 bits"}, expected, opened);
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
