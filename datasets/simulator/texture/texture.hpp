// A repeating square image of reflectances with a pyramid, so that it can be seen from any distance without
// aliasing.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/image.hpp"

namespace fusebench::simulator::texture {

class Texture {
 public:
  /// Square, its side a power of two (checked); linear reflectances 0 to 1. Pixel (0, 0) covers (0, 0) to (1,
  /// 1) / side.
  explicit Texture(const Image<Eigen::Vector3f>& image);

  [[nodiscard]] int side() const { return side_; }
  [[nodiscard]] int levels() const { return static_cast<int>(levels_.size()); }

  /// Reflectance at (u, v) in repeats of the image, averaged over about `footprint` texels of the full image
  /// (trilinear). The fourth component means nothing.
  [[nodiscard]] Eigen::Array4f sample(float u, float v, float footprint) const {
    const float level = std::clamp(log2_piecewise(footprint), 0.0F, static_cast<float>(levels() - 1));
    const int lower = static_cast<int>(level);
    const float fraction = level - static_cast<float>(lower);
    const Eigen::Array4f fine = bilinear(lower, u, v);
    if (fraction == 0.0F) return fine;
    return fine + fraction * (bilinear(lower + 1, u, v) - fine);
  }

 private:
  struct Level {
    std::size_t offset = 0;
    int side = 0;
  };

  /// Base-2 logarithm that is exact at powers of two and linear between them: monotonic, continuous, cheap.
  static float log2_piecewise(float x) {
    const auto bits = std::bit_cast<std::int32_t>(x);
    return static_cast<float>(bits - (127 << 23)) * 0x1p-23F;
  }

  [[nodiscard]] Eigen::Array4f bilinear(int level, float u, float v) const {
    const Level& at = levels_[static_cast<std::size_t>(level)];
    const float x = u * static_cast<float>(at.side) - 0.5F;
    const float y = v * static_cast<float>(at.side) - 0.5F;
    const float floor_x = std::floor(x);
    const float floor_y = std::floor(y);
    const int mask = at.side - 1;
    const int x0 = static_cast<int>(floor_x) & mask;
    const int y0 = static_cast<int>(floor_y) & mask;
    const int x1 = (x0 + 1) & mask;
    const int y1 = (y0 + 1) & mask;
    const Eigen::Array4f* texels = texels_.data() + at.offset;
    const Eigen::Array4f* row0 = texels + static_cast<std::ptrdiff_t>(y0) * at.side;
    const Eigen::Array4f* row1 = texels + static_cast<std::ptrdiff_t>(y1) * at.side;
    const float fx = x - floor_x;
    const float fy = y - floor_y;
    const Eigen::Array4f top = row0[x0] + fx * (row0[x1] - row0[x0]);
    const Eigen::Array4f bottom = row1[x0] + fx * (row1[x1] - row1[x0]);
    return top + fy * (bottom - top);
  }

  int side_ = 0;
  std::vector<Level> levels_;  // full image first, down to one texel
  std::vector<Eigen::Array4f> texels_;
};

/// sRGB (IEC 61966-2-1) value 0-1 of linear light 0-1, and back.
[[nodiscard]] double srgb_from_linear(double light);
[[nodiscard]] double linear_from_srgb(double value);

}  // namespace fusebench::simulator::texture
