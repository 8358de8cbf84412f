// Interface of the image library, a module that is loaded on first use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "datasets/images/pixel_view.hpp"

namespace fusebench::images {

/// A result of the library or its error message.
template <class T>
using LibraryResult = tl::expected<T, std::string>;

struct ImageHeader {
  int width_px = 0;
  int height_px = 0;
  int channels = 0;
  SampleType type = SampleType::other;
  std::string type_name;           ///< as in the library: "uint8", "float"
  std::uint64_t stored_bytes = 0;  ///< of all pixels before compression: two for a half float
  std::string compression;         ///< as in the library: "zip", "dwaa"
};

struct OpenedImage {
  ImageHeader header;
  /// Decodes the first `channels` channels into `pixels`, which has the size of their samples, in the layout
  /// of PixelView.
  std::function<LibraryResult<void>(int channels, std::span<std::byte> pixels)> read_pixels;
};

/// Functions of the library; thread-safe. A struct of pointers, not virtual functions: a module that is
/// loaded at run time has its own type information, which sanitizers report as a mismatch.
struct ImageLibrary {
  /// Half-float samples are read as float32.
  LibraryResult<OpenedImage> (*open)(const std::string& file) = nullptr;
  /// name: file name with the extension of the format. The bytes must outlive the opened image.
  LibraryResult<OpenedImage> (*open_bytes)(const std::string& name,
                                           std::span<const std::byte> bytes) = nullptr;
  /// quality: 1 to 100.
  LibraryResult<std::vector<std::uint8_t>> (*encode_jpeg)(const PixelView& image, int quality) = nullptr;
};

/// Equal in a compatible program and module, since the layout of the types above depends on the compiler.
/// Increase the number with each change of this file.
inline constexpr const char* kImageLibraryBuild = "images 3, compiler " __VERSION__;

/// The only symbol that the module exports.
inline constexpr const char* kImageLibraryFunction = "fusebench_image_library";

}  // namespace fusebench::images

/// Returns the library, or null if `build` differs from the module's kImageLibraryBuild.
extern "C" [[gnu::visibility("default")]] const fusebench::images::ImageLibrary* fusebench_image_library(
    const char* build);
