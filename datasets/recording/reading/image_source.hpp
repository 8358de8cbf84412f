// Where the images of a recording are: in a file each, or in one file for all of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/fingerprint.hpp"
#include "core/base/types.hpp"
#include "datasets/images/image_files.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::reading {

/// Reads one depth image of the given size: z-depth in metres, 0 = no measurement, not yet undistorted or
/// registered. opened: the bytes that the file must have. Called from several threads.
using DepthReader =
    std::function<Result<DepthImage>(const std::filesystem::path& file, const images::ImageSize& expected,
                                     const std::optional<io::ContentHash>& opened)>;

/// 16-bit values in metres; units_per_metre: the value of one metre. 0 and 65535 are no measurement.
[[nodiscard]] DepthImage depth_in_metres(const Image<std::uint16_t>& values, double units_per_metre);

/// 16-bit grey PNGs, as depth_in_metres() takes their values.
[[nodiscard]] DepthReader png_depth(double units_per_metre);

/// Of a frame's two images, as they are stored.
struct ImageHashes {
  io::ContentHash color;
  io::ContentHash depth;
};

/// The images of a recording by the number of their frame. Called from several threads.
struct ImageSource {
  /// Of the first colour image.
  std::function<Result<images::ImageSize>()> color_size;
  /// Of the first depth image, as the header of a PNG says; nothing for others.
  std::function<std::optional<images::ImageSize>()> depth_size;
  /// Adds the stored bytes of both images.
  std::function<Result<ImageHashes>(std::size_t frame, io::Fingerprint& fingerprint)> add_to;
  /// Colour as images::read_color(), depth as DepthReader.
  std::function<Result<ColorImage>(std::size_t frame, const images::ImageSize& expected,
                                   const io::ContentHash& opened)>
      read_color;
  std::function<Result<DepthImage>(std::size_t frame, const images::ImageSize& expected,
                                   const io::ContentHash& opened)>
      read_depth;
};

/// Images that are files of their own; colour is read by images::read_color().
[[nodiscard]] ImageSource image_files(std::vector<recording::FrameEntry> frames, DepthReader read_depth);

/// The stored bytes of an image within a larger file.
struct StoredImage {
  std::string name;  ///< for messages: "room.sens: colour of frame 3"
  std::string bytes;
};

/// Images that are parts of one file.
struct StoredImages {
  std::function<Result<StoredImage>(std::size_t frame)> color;
  std::function<Result<StoredImage>(std::size_t frame)> depth;
  std::function<Result<ColorImage>(const StoredImage& image)> decode_color;
  std::function<Result<DepthImage>(const StoredImage& image)> decode_depth;  ///< as DepthReader
};
[[nodiscard]] ImageSource stored_images(StoredImages images);

}  // namespace fusebench::reading
