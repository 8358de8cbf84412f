// Interface of the image library: a module that is loaded on first use.
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

/// A result of the library, or its error message.
template <class T>
using LibraryResult = tl::expected<T, std::string>;

struct ImageHeader {
  int width_px = 0;
  int height_px = 0;
  int channels = 0;
  SampleType type = SampleType::other;
  std::string type_name;           ///< as the library names it: "uint8", "float"
  std::uint64_t stored_bytes = 0;  ///< of all pixels before their compression: a half has two
  std::string compression;         ///< as the library names it: "zip", "dwaa"
};

struct OpenedImage {
  ImageHeader header;
  /// Decodes the first so many channels into as many bytes as their samples have, laid out as those of a
  /// PixelView.
  std::function<LibraryResult<void>(int channels, std::span<std::byte> pixels)> read_pixels;
};

/// May be used by several threads at once. Not a class with virtual functions: a module that is loaded late
/// has type information of its own, which a sanitizer takes for that of another class.
struct ImageLibrary {
  /// Samples that are half floats are read as float32.
  LibraryResult<OpenedImage> (*open)(const std::string& file) = nullptr;
  /// name: as a file of these bytes would be called, which tells the format. The bytes must stay as long as
  /// the image is open.
  LibraryResult<OpenedImage> (*open_bytes)(const std::string& name,
                                           std::span<const std::byte> bytes) = nullptr;
  /// quality: 1 to 100.
  LibraryResult<std::vector<std::uint8_t>> (*encode_jpeg)(const PixelView& image, int quality) = nullptr;
};

/// Equal in a program and a module that fit together: what is above is laid out by the compiler. The number
/// counts the changes of this file.
inline constexpr const char* kImageLibraryBuild = "images 3, compiler " __VERSION__;

/// All that the module exports.
inline constexpr const char* kImageLibraryFunction = "fusebench_image_library";

}  // namespace fusebench::images

/// The module's library, or null if `build` is not the module's own kImageLibraryBuild.
extern "C" [[gnu::visibility("default")]] const fusebench::images::ImageLibrary* fusebench_image_library(
    const char* build);
