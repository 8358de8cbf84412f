#include "datasets/images/png_writer.hpp"

#include <png.h>

#include <bit>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>

namespace fusebench::images {

namespace {

// A quarter of the default's time for a tenth more bytes: 18 ms instead of 75 for 640x480 colour.
constexpr int kCompressionLevel = 2;
constexpr int kFilters = PNG_FILTER_SUB;

void remember(png_structp png, png_const_charp reason) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = reason;
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

/// State of the library; released in the destructor.
struct Writer {
  explicit Writer(std::string& reason)
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &reason, remember, ignore)),
        info(png != nullptr ? png_create_info_struct(png) : nullptr) {}
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  png_structp png;
  png_infop info;
};

/// False if the library gave up. It does so by a jump over frames, so that nothing here may need a
/// destructor.
bool write_rows(png_structp png, png_infop info, std::FILE* file, const PixelView& image) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  const bool wide = image.type == SampleType::uint16;
  png_init_io(png, file);
  png_set_compression_level(png, kCompressionLevel);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, kFilters);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width_px), static_cast<png_uint_32>(image.height_px),
               wide ? 16 : 8, image.channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (wide && std::endian::native == std::endian::little) png_set_swap(png);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  for (std::size_t row = 0; row < static_cast<std::size_t>(image.height_px); ++row) {
    png_write_row(png, reinterpret_cast<png_const_bytep>(image.pixels.data() + row * row_bytes));
  }
  png_write_end(png, info);
  return true;
}

}  // namespace

tl::expected<void, std::string> write_png_file(const std::filesystem::path& file, const PixelView& image) {
  const auto reason_of_system = [] { return tl::unexpected(std::string(std::strerror(errno))); };
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> output(std::fopen(file.c_str(), "wb"), std::fclose);
  if (!output) return reason_of_system();
  std::string reason = "not enough memory";
  const Writer writer(reason);
  if (writer.info == nullptr || !write_rows(writer.png, writer.info, output.get(), image)) {
    // The error of the operating system is more specific than "Write Error".
    if (std::ferror(output.get()) != 0) return reason_of_system();
    return tl::unexpected(reason);
  }
  if (std::fclose(output.release()) != 0) return reason_of_system();
  return {};
}

}  // namespace fusebench::images
