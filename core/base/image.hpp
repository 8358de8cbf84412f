// Images as plain values: row-major, no padding, pixel (x, y) has its centre at integer coordinates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fusebench {
inline namespace base {

template <class Pixel>
struct Image {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  std::vector<Pixel> data;

  Image() = default;
  Image(int width_px, int height_px, Pixel fill = {})
      : width(width_px),
        height(height_px),
        data(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), fill) {}

  [[nodiscard]] bool empty() const { return data.empty(); }
  /// Reuses the allocation. The pixel values are unspecified afterwards.
  void resize(int width_px, int height_px) {
    width = width_px;
    height = height_px;
    data.resize(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] Pixel& operator()(int x, int y) { return data[index(x, y)]; }
  [[nodiscard]] const Pixel& operator()(int x, int y) const { return data[index(x, y)]; }
  [[nodiscard]] bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

using Rgb = std::array<std::uint8_t, 3>;  ///< red, green, blue
using GreyImage = Image<std::uint8_t>;    ///< grey levels 0-255
using ColorImage = Image<Rgb>;
using DepthImage = Image<float>;  ///< z-depth along the optical axis in metres, 0 = no measurement

/// An interpolated grey level and its derivative by the coordinates (grey levels per pixel).
struct IntensitySample {
  double value = 0;
  double dx = 0;
  double dy = 0;
};

/// Bilinear interpolation with the exact derivative of the interpolant, so analytic Jacobians equal numeric
/// ones. Requires 0 <= x <= width - 1 and 0 <= y <= height - 1 (not checked). Pixels are bytes or floats.
template <class Pixel>
[[nodiscard]] IntensitySample sample_bilinear(const Image<Pixel>& image, double x, double y);

/// Grey-level pyramid: level 0 is the image, each further level has half the size (5x5 binomial filter in
/// integer arithmetic, identical on all machines). Pixel (x, y) of level l is at (x, y) * 2^l of level 0.
[[nodiscard]] std::vector<GreyImage> build_pyramid(const GreyImage& image, int levels);
/// Variant of build_pyramid() that reuses the buffers of `pyramid`.
void build_pyramid(const GreyImage& image, int levels, std::vector<GreyImage>& pyramid);

/// Grey image by ITU-R BT.601 weights: 0.299 R + 0.587 G + 0.114 B, in integer arithmetic.
[[nodiscard]] GreyImage to_grey(const ColorImage& color);

}  // namespace base
}  // namespace fusebench
