// A periodic square reflectance image with a pyramid for antialiasing at any distance.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/base/image.hpp"
#include "core/base/simd/half_lanes.hpp"

namespace fusebench::simulator::texture {

class Texture {
 public:
  /// Square with a power of two as its side (checked); linear reflectances 0 to 1. Pixel (0, 0) covers (0, 0)
  /// to (1, 1) / side.
  explicit Texture(const Image<Eigen::Vector3f>& image);

  [[nodiscard]] int side() const { return side_; }
  [[nodiscard]] int levels() const { return static_cast<int>(offsets_.size()); }

  /// Reflectances by lane; the fourth component is unused.
  using Samples = std::array<Eigen::Array4f, simd::kLanes>;

  /// Samples at (u, v) in repeats of the image, averaged over about `footprint` texels of the full image
  /// (trilinear). Sets the lanes whose bit is set.
  void sample(simd::Float8 u, simd::Float8 v, simd::Float8 footprint, unsigned lanes,
              Samples& samples) const {
    const simd::Float8 level = simd::clamp(log2_piecewise(footprint), 0, static_cast<float>(levels() - 1));
    const simd::Int8 lower = simd::to_int(level);
    const simd::Float8 share = level - simd::to_float(lower);
    const Places fine = places(lower, u, v);
    const Places coarse = places(simd::min(lower + 1, simd::all_lanes(levels() - 1)), u, v);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      const Float4 near = bilinear(fine, lane);
      const Float4 mixed = near + share[lane] * (bilinear(coarse, lane) - near);
      std::memcpy(samples[lane].data(), &mixed, sizeof(mixed));
    }
  }

  /// Samples one position.
  [[nodiscard]] Eigen::Array4f sample(float u, float v, float footprint) const {
    Samples samples;
    sample(simd::all_lanes(u), simd::all_lanes(v), simd::all_lanes(footprint), 1, samples);
    return samples[0];
  }

 private:
  /// Rows of side + 1 texels; the last one repeats the first, so that two neighbours are one load.
  static constexpr int kChannels = 4;
  using Float4 [[gnu::vector_size(16)]] = float;

  /// Piecewise linear base-2 logarithm, exact at powers of two: monotonic and continuous.
  static simd::Float8 log2_piecewise(simd::Float8 x) {
    const auto bits = std::bit_cast<simd::Int8>(x);
    return simd::to_float(bits - (127 << 23)) * 0x1p-23F;
  }

  /// The four texels around a position, in pairs.
  struct Places {
    simd::Int8 above, below;   ///< index of the left one
    simd::Float8 right, down;  ///< weights of the right and the lower texels
  };
  [[nodiscard]] Places places(simd::Int8 level, simd::Float8 u, simd::Float8 v) const {
    const auto scale = std::bit_cast<simd::Float8>((127 - level) << 23);  // 2^-level
    const simd::Float8 side = static_cast<float>(side_) * scale;
    const simd::Float8 x = u * side - 0.5F;
    const simd::Float8 y = v * side - 0.5F;
    const simd::Int8 floor_x = simd::floor_to_int(x);
    const simd::Int8 floor_y = simd::floor_to_int(y);
    const simd::Int8 mask = simd::to_int(side) - 1;
    const simd::Int8 stride = kChannels * (mask + 2);
    const simd::Int8 column = simd::gather(offsets_.data(), level) + kChannels * (floor_x & mask);
    return {column + stride * (floor_y & mask), column + stride * ((floor_y + 1) & mask),
            x - simd::to_float(floor_x), y - simd::to_float(floor_y)};
  }

  [[nodiscard]] Float4 bilinear(const Places& at, std::size_t lane) const {
    const simd::Float8 above = simd::load(texels_.data() + at.above[lane]);
    const simd::Float8 below = simd::load(texels_.data() + at.below[lane]);
    const simd::Float8 pair = above + at.down[lane] * (below - above);
    const Float4 left = __builtin_shufflevector(pair, pair, 0, 1, 2, 3);
    const Float4 right = __builtin_shufflevector(pair, pair, 4, 5, 6, 7);
    return left + at.right[lane] * (right - left);
  }

  void add_level(const Image<Eigen::Vector3f>& image);

  int side_ = 0;
  std::vector<std::int32_t> offsets_;  // of the levels in texels_: from the full image to one texel
  std::vector<simd::Half> texels_;     // kChannels each
};

/// sRGB (IEC 61966-2-1) value 0-1 of linear light 0-1, and back.
[[nodiscard]] double srgb_from_linear(double light);
[[nodiscard]] double linear_from_srgb(double value);

}  // namespace fusebench::simulator::texture
