#include "datasets/recording/formats/rosbag/ros_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "core/base/printable.hpp"
#include "datasets/images/image_files.hpp"
#include "datasets/recording/reading/image_source.hpp"

namespace fusebench::formats::rosbag {

namespace {

constexpr std::size_t kCompressedDepthHeader = 12;  // compressed_depth_image_transport: format and two floats
constexpr float kFarthest_m = 1000;

tl::unexpected<Error> wrong(const std::string& name, std::string_view what) {
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", name, what));
}

/// The rows of an image with pixels of that many bytes have their place in the data.
Result<void> check_rows(const ImageMessage& image, std::size_t pixel_bytes, const std::string& name) {
  const std::size_t row = pixel_bytes * image.width_px;
  const bool size = image.width_px >= 1 && image.height_px >= 1 && image.width_px <= kMostPixelsASide &&
                    image.height_px <= kMostPixelsASide;
  if (size && image.step_bytes >= row &&
      image.data.size() >= static_cast<std::size_t>(image.step_bytes) * (image.height_px - 1) + row)
    return {};
  return wrong(name,
               fmt::format("{} bytes in rows of {} are not {}x{} pixels of {}", image.data.size(),
                           image.step_bytes, image.width_px, image.height_px, printable(image.encoding)));
}

const char* row_of(const ImageMessage& image, int y) {
  return image.data.data() + static_cast<std::size_t>(y) * image.step_bytes;
}

DepthImage float_depth(const ImageMessage& image) {
  DepthImage depth_m(static_cast<int>(image.width_px), static_cast<int>(image.height_px));
  for (int y = 0; y < depth_m.height; ++y) {
    const char* const row = row_of(image, y);
    for (int x = 0; x < depth_m.width; ++x) {
      std::array<char, 4> raw{};
      std::copy_n(row + 4 * x, raw.size(), raw.begin());
      const auto z_m = std::bit_cast<float>(raw);
      depth_m(x, y) = z_m > 0 && z_m <= kFarthest_m ? z_m : 0.0F;  // NaN and infinity: no measurement
    }
  }
  return depth_m;
}

Image<std::uint16_t> integer_depth(const ImageMessage& image) {
  Image<std::uint16_t> values(static_cast<int>(image.width_px), static_cast<int>(image.height_px));
  for (int y = 0; y < values.height; ++y) {
    const char* const row = row_of(image, y);
    for (int x = 0; x < values.width; ++x) {
      const auto low = static_cast<unsigned char>(row[2 * x]);
      const auto high = static_cast<unsigned char>(row[2 * x + 1]);
      values(x, y) = static_cast<std::uint16_t>(low | high << 8);
    }
  }
  return values;
}

}  // namespace

Result<ColorImage> color_of(const ImageMessage& image, const std::string& name) {
  if (image.width_px == 0) return images::decode_color(name, image.data);
  if (!is_color_encoding(image.encoding))
    return wrong(name,
                 fmt::format("encoding '{}' (read are {})", printable(image.encoding), kColorEncodings));
  const bool grey = is_grey_encoding(image.encoding);
  const bool alpha = image.encoding.find('a') != std::string::npos;
  const int pixel_bytes = grey ? 1 : (alpha ? 4 : 3);
  if (const auto fits = check_rows(image, static_cast<std::size_t>(pixel_bytes), name); !fits)
    return tl::unexpected(fits.error());
  const bool blue_first = image.encoding.starts_with("bgr");
  const std::array<int, 3> channels = grey         ? std::array{0, 0, 0}
                                      : blue_first ? std::array{2, 1, 0}
                                                   : std::array{0, 1, 2};
  ColorImage color(static_cast<int>(image.width_px), static_cast<int>(image.height_px));
  for (int y = 0; y < color.height; ++y) {
    const char* pixel = row_of(image, y);
    for (int x = 0; x < color.width; ++x, pixel += pixel_bytes) {
      for (std::size_t c = 0; c < 3; ++c) color(x, y)[c] = static_cast<std::uint8_t>(pixel[channels[c]]);
    }
  }
  return color;
}

Result<DepthImage> depth_of(const ImageMessage& image, double units_per_metre, const std::string& name) {
  if (image.width_px == 0) {
    const std::size_t begin = is_compressed_depth(image.encoding) ? kCompressedDepthHeader : 0;
    if (image.data.size() < begin || !image.encoding.starts_with("16UC1"))
      return wrong(name, fmt::format("compressed depth '{}' (16UC1 is read)", printable(image.encoding)));
    const auto values = images::decode_depth16(name, image.data.substr(begin));
    if (!values) return tl::unexpected(values.error());
    return reading::depth_in_metres(*values, units_per_metre);
  }
  const bool is_float = image.encoding == "32FC1";
  if (!is_depth_encoding(image.encoding) || image.is_big_endian)
    return wrong(name, fmt::format("encoding '{}'{} (read are {}, little-endian)", printable(image.encoding),
                                   image.is_big_endian ? ", big-endian" : "", kDepthEncodings));
  if (const auto fits = check_rows(image, is_float ? 4 : 2, name); !fits) return tl::unexpected(fits.error());
  return is_float ? float_depth(image) : reading::depth_in_metres(integer_depth(image), units_per_metre);
}

}  // namespace fusebench::formats::rosbag
