// Module with the image library. The only file that includes OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "datasets/images/image_library.hpp"

namespace fusebench::images {

namespace {

/// Sample type for reading: half floats become floats.
OIIO::TypeDesc read_type_of(const OIIO::ImageSpec& spec) {
  return spec.format == OIIO::TypeDesc::HALF ? OIIO::TypeDesc(OIIO::TypeDesc::FLOAT) : spec.format;
}

SampleType sample_type_of(const OIIO::TypeDesc& type) {
  if (type == OIIO::TypeDesc::UINT8) return SampleType::uint8;
  if (type == OIIO::TypeDesc::UINT16) return SampleType::uint16;
  if (type == OIIO::TypeDesc::FLOAT) return SampleType::float32;
  return SampleType::other;
}

LibraryResult<void> read_pixels(OIIO::ImageInput& input, int channels, std::span<std::byte> pixels) {
  const OIIO::ImageSpec& spec = input.spec();
  const OIIO::TypeDesc type = read_type_of(spec);
  // An image may have a depth in addition to width and height.
  if (pixels.size() != spec.image_pixels() * static_cast<std::uint64_t>(channels) * type.size())
    return tl::unexpected(std::string("its pixels do not match its width and height"));
  if (!input.read_image(0, 0, 0, channels, type, pixels.data())) return tl::unexpected(input.geterror());
  return {};
}

/// owned: source of the input, kept alive with it.
template <class Owned>
LibraryResult<OpenedImage> opened(std::shared_ptr<OIIO::ImageInput> input, Owned owned) {
  if (!input) return tl::unexpected(OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  const OIIO::TypeDesc type = read_type_of(spec);
  return OpenedImage{{spec.width, spec.height, spec.nchannels, sample_type_of(type), type.c_str(),
                      spec.image_bytes(true), std::string(spec.get_string_attribute("compression"))},
                     [owned, input](int channels, std::span<std::byte> pixels) {
                       return read_pixels(*input, channels, pixels);
                     }};
}

/// Stored colours without the multiplication by alpha, which is the library's default.
OIIO::ImageSpec stored_colors() {
  OIIO::ImageSpec settings;
  settings.attribute("oiio:UnassociatedAlpha", 1);
  return settings;
}

LibraryResult<OpenedImage> open_image(const std::string& file) {
  const OIIO::ImageSpec settings = stored_colors();
  return opened(OIIO::ImageInput::open(file, &settings), nullptr);
}

LibraryResult<OpenedImage> open_bytes(const std::string& name, std::span<const std::byte> bytes) {
  const auto memory =
      std::make_shared<OIIO::Filesystem::IOMemReader>(const_cast<std::byte*>(bytes.data()), bytes.size());
  OIIO::ImageSpec settings = stored_colors();
  // With this setting, the library reads from these bytes only.
  OIIO::Filesystem::IOProxy* const source = memory.get();
  settings.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &source);
  return opened(OIIO::ImageInput::open(name, &settings, source), memory);
}

LibraryResult<std::vector<std::uint8_t>> encode_jpeg(const PixelView& image, int quality) {
  std::vector<std::uint8_t> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("jpeg");
  if (!output) return tl::unexpected(OIIO::geterror());
  OIIO::ImageSpec spec(image.width_px, image.height_px, image.channels, OIIO::TypeDesc::UINT8);
  spec.attribute("CompressionQuality", quality);
  // If memory is exhausted, the writer is not destroyed: its destructor writes the missing lines and does not
  // return if compression has not begun.
  try {
    if (output->set_ioproxy(&memory) && output->open("memory.jpg", spec) &&
        output->write_image(spec.format, image.pixels.data()) && output->close())
      return bytes;
  } catch (...) {
    static_cast<void>(output.release());
    throw;
  }
  std::string reason = output->geterror();
  static_cast<void>(output.release());
  return tl::unexpected(std::move(reason));
}

constexpr ImageLibrary kLibrary{open_image, open_bytes, encode_jpeg};

}  // namespace

}  // namespace fusebench::images

const fusebench::images::ImageLibrary* fusebench_image_library(const char* build) {
  if (std::string_view(build) != fusebench::images::kImageLibraryBuild) return nullptr;
  // Decoding runs in this program's own parallel loops, so the library must not start threads. OpenEXR must
  // have none either (-1): in a run forked from an engine, decoding would wait for threads that do not exist.
  static const bool done = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
  static_cast<void>(done);
  return &fusebench::images::kLibrary;
}
