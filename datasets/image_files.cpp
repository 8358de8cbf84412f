#include "datasets/image_files.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include "datasets/plain_png.hpp"
#include "datasets/png_check.hpp"

namespace fusebench {

namespace {

/// Decoding runs inside of our own parallel loops, so the library must not start threads of its own.
void use_one_thread_per_image() {
  static const bool done = OIIO::attribute("threads", 1);
  static_cast<void>(done);
}

/// The library's reason in one line.
std::string library_reason(std::string reason) {
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == '.')) reason.pop_back();
  for (char& c : reason) c = c == '\n' ? ' ' : c;
  return reason.empty() ? "no reason given" : reason;
}

tl::unexpected<Error> corrupt(const std::filesystem::path& file, std::string_view what) {
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", file.string(), what));
}

/// A header may claim any size. PNG's compression makes at most 1032 bytes of one, and JPEG's less in
/// practice, so that memory stays in proportion to the file.
Result<void> check_claim(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
  constexpr std::uintmax_t kMostPerByte = 1032;
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(file, ignored);
  if (spec.image_bytes() / kMostPerByte <= bytes) return {};
  return corrupt(file, fmt::format("damaged image (its header claims {}x{} "
                                   "pixels, too many for {} bytes)",
                                   spec.width, spec.height, bytes));
}

Result<std::unique_ptr<OIIO::ImageInput>> open_image(const std::filesystem::path& file) {
  use_one_thread_per_image();
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no such image", file.string()));
  }
  if (const std::string damage = png_damage(file); !damage.empty()) return corrupt(file, damage);
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file.string());
  if (!input) return corrupt(file, fmt::format("unreadable image: {}", library_reason(OIIO::geterror())));
  if (const auto sound = check_claim(file, input->spec()); !sound) return tl::unexpected(sound.error());
  return input;
}

/// What the caller needs the file to hold.
struct Layout {
  int channels = 0;
  OIIO::TypeDesc type;
  std::string_view name;
};

template <class Pixel>
Result<Image<Pixel>> read_image(const std::filesystem::path& file, const Layout& layout,
                                std::optional<ImageSize> expected) {
  auto input = open_image(file);
  if (!input) return tl::unexpected(input.error());
  const OIIO::ImageSpec& spec = (*input)->spec();
  if (spec.nchannels != layout.channels || spec.format != layout.type) {
    return corrupt(file, fmt::format("expected {}, got {} channel(s) of {}", layout.name, spec.nchannels,
                                     spec.format.c_str()));
  }
  if (expected && *expected != ImageSize{spec.width, spec.height}) {
    return corrupt(file, fmt::format("expected {}x{} pixels, got {}x{}", expected->width_px,
                                     expected->height_px, spec.width, spec.height));
  }
  Image<Pixel> image(spec.width, spec.height);
  if (!(*input)->read_image(0, 0, 0, layout.channels, layout.type, image.data.data())) {
    return corrupt(file, fmt::format("truncated or damaged image: {}", library_reason((*input)->geterror())));
  }
  return image;
}

/// What the recordings at hand consist of takes the short way; whatever is not as it should be is left to the
/// library, which knows why.
template <class Pixel>
Result<Image<Pixel>> plain_or_any(std::optional<Image<Pixel>> plain, const std::filesystem::path& file,
                                  const Layout& layout, std::optional<ImageSize> expected) {
  const bool good = plain && (!expected || *expected == ImageSize{plain->width, plain->height});
  return good ? Result<Image<Pixel>>(std::move(*plain)) : read_image<Pixel>(file, layout, expected);
}

template <class Pixel>
Result<void> write_image(const std::filesystem::path& file, const Image<Pixel>& image, int channels,
                         OIIO::TypeDesc type) {
  use_one_thread_per_image();
  const auto failed = [&](std::string reason) {
    return fail(ErrorCode::io,
                fmt::format("{}: cannot be written: {}", file.string(), library_reason(std::move(reason))));
  };
  // By format, not by the file's name, which need not end in ".png".
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("png");
  if (!output) return failed(OIIO::geterror());
  OIIO::ImageSpec spec(image.width, image.height, channels, type);
  // A quarter of the default's time for a tenth more bytes: 18 ms instead of 75 for 640x480 colour.
  constexpr int kSubFilter = 0x10;
  spec.attribute("png:compressionLevel", 2);
  spec.attribute("png:filter", kSubFilter);
  if (!output->open(file.string(), spec) || !output->write_image(type, image.data.data()) ||
      !output->close()) {
    return failed(output->geterror());
  }
  return {};
}

}  // namespace

Result<ImageSize> read_image_size(const std::filesystem::path& file) {
  const auto input = open_image(file);
  if (!input) return tl::unexpected(input.error());
  return ImageSize{(*input)->spec().width, (*input)->spec().height};
}

Result<ColorImage> read_color(const std::filesystem::path& file, std::optional<ImageSize> expected) {
  return plain_or_any(read_plain_png_color(file), file,
                      {3, OIIO::TypeDesc::UINT8, "an RGB image with 8 bits a channel"}, expected);
}

Result<GreyImage> read_grey(const std::filesystem::path& file, std::optional<ImageSize> expected) {
  return read_image<std::uint8_t>(file, {1, OIIO::TypeDesc::UINT8, "a grey image with 8 bits"}, expected);
}

Result<Image<std::uint16_t>> read_depth16(const std::filesystem::path& file,
                                          std::optional<ImageSize> expected) {
  return plain_or_any(read_plain_png_grey16(file), file,
                      {1, OIIO::TypeDesc::UINT16, "a grey image with 16 bits"}, expected);
}

Result<void> write_png(const std::filesystem::path& file, const ColorImage& image) {
  return write_image(file, image, 3, OIIO::TypeDesc::UINT8);
}

Result<void> write_png(const std::filesystem::path& file, const GreyImage& image) {
  return write_image(file, image, 1, OIIO::TypeDesc::UINT8);
}

Result<void> write_png(const std::filesystem::path& file, const Image<std::uint16_t>& image) {
  return write_image(file, image, 1, OIIO::TypeDesc::UINT16);
}

Result<std::vector<std::uint8_t>> encode_jpeg(const ColorImage& image, int quality) {
  use_one_thread_per_image();
  const auto failed = [](std::string reason) {
    return fail(ErrorCode::io, fmt::format("JPEG in memory: {}", library_reason(std::move(reason))));
  };
  std::vector<std::uint8_t> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("jpeg");
  if (!output) return failed(OIIO::geterror());
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("CompressionQuality", quality);
  if (!output->set_ioproxy(&memory) || !output->open("memory.jpg", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, image.data.data()) || !output->close()) {
    return failed(output->geterror());
  }
  return bytes;
}

}  // namespace fusebench
