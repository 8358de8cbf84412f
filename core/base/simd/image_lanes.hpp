// Grey levels at eight image positions.
#pragma once

#include <array>

#include "core/base/image.hpp"
#include "core/base/simd/lanes.hpp"

namespace fusebench::simd {

/// IntensitySample for eight lanes.
struct IntensityLanes {
  Float8 value{};
  Float8 dx{};
  Float8 dy{};
};

namespace lane_details {

/// Byte number `at` of each word.
[[nodiscard]] inline Float8 byte_of(Int8 words, int at) { return to_float((words >> (8 * at)) & 0xFF); }

/// a + b t.
[[nodiscard]] inline Float8 linear(Float8 t, float a, float b) { return multiply_add(b, t, all_lanes(a)); }
/// a + b t + c t^2.
[[nodiscard]] inline Float8 quadratic(Float8 t, float a, float b, float c) {
  return multiply_add(t, linear(t, b, c), all_lanes(a));
}

/// Weights of four pixels for a position between the second and the third.
[[nodiscard]] inline std::array<Float8, 4> cubic_weights(Float8 t) {
  const Float8 squared = t * t;
  return {t * quadratic(t, -0.5F, 1.0F, -0.5F),
          multiply_add(squared, linear(t, -2.5F, 1.5F), all_lanes(1.0F)), t * quadratic(t, 0.5F, 2.0F, -1.5F),
          squared * linear(t, -0.5F, 0.5F)};
}
/// Derivatives of the weights.
[[nodiscard]] inline std::array<Float8, 4> cubic_slopes(Float8 t) {
  return {quadratic(t, -0.5F, 2.0F, -1.5F), t * linear(t, -5.0F, 4.5F), quadratic(t, 0.5F, 4.0F, -4.5F),
          t * linear(t, -1.0F, 1.5F)};
}

[[nodiscard]] inline Float8 weighted(const std::array<Float8, 4>& weights,
                                     const std::array<Float8, 4>& values) {
  const Float8 first = multiply_add(weights[1], values[1], weights[0] * values[0]);
  return multiply_add(weights[3], values[3], multiply_add(weights[2], values[2], first));
}

/// Four consecutive pixels of a row from each position on.
[[nodiscard]] inline std::array<Float8, 4> four_pixels(const GreyImage& image, Int8 at) {
  const Int8 words = gather_bytes(image.data.data(), image.data.size(), at);
  return {byte_of(words, 0), byte_of(words, 1), byte_of(words, 2), byte_of(words, 3)};
}

}  // namespace lane_details

/// Cubic convolution (Keys 1981, a = -1/2) with the exact derivative of the interpolant. The blur of a
/// bilinear sample depends on its sub-pixel position, which biases an alignment towards whole pixels; cubic
/// convolution has little of this bias. Requires 1 <= x <= width - 2 (same for y) in all lanes.
[[nodiscard]] inline IntensityLanes sample_bicubic(const GreyImage& image, Float8 x, Float8 y) {
  using namespace lane_details;
  const Int8 left = min(to_int(x), all_lanes(image.width - 3));
  const Int8 top = min(to_int(y), all_lanes(image.height - 3));
  const Float8 tx = x - to_float(left);
  const Float8 ty = y - to_float(top);
  const auto across = cubic_weights(tx);
  const auto across_slopes = cubic_slopes(tx);
  const auto down = cubic_weights(ty);
  const auto down_slopes = cubic_slopes(ty);
  IntensityLanes sample;
  Int8 at = (top - 1) * image.width + left - 1;
  for (std::size_t row = 0; row < 4; ++row, at += image.width) {
    const auto pixels = four_pixels(image, at);
    const Float8 value = weighted(across, pixels);
    sample.value = multiply_add(down[row], value, sample.value);
    sample.dx = multiply_add(down[row], weighted(across_slopes, pixels), sample.dx);
    sample.dy = multiply_add(down_slopes[row], value, sample.dy);
  }
  return sample;
}

/// Value of sample_bicubic() without the derivative.
[[nodiscard]] inline Float8 sample_bicubic_value(const GreyImage& image, Float8 x, Float8 y) {
  using namespace lane_details;
  const Int8 left = min(to_int(x), all_lanes(image.width - 3));
  const Int8 top = min(to_int(y), all_lanes(image.height - 3));
  const auto across = cubic_weights(x - to_float(left));
  const auto down = cubic_weights(y - to_float(top));
  Float8 value{};
  Int8 at = (top - 1) * image.width + left - 1;
  for (std::size_t row = 0; row < 4; ++row, at += image.width) {
    value = multiply_add(down[row], weighted(across, four_pixels(image, at)), value);
  }
  return value;
}

/// Value of the scalar sample_bilinear(). Requires 0 <= x <= width - 1 (same for y) in all lanes.
[[nodiscard]] inline Float8 sample_bilinear_value(const GreyImage& image, Float8 x, Float8 y) {
  using lane_details::byte_of;
  const Int8 left = min(to_int(x), all_lanes(image.width - 2));
  const Int8 top = min(to_int(y), all_lanes(image.height - 2));
  const Float8 ax = x - to_float(left);
  const Float8 ay = y - to_float(top);
  const Int8 at = top * image.width + left;
  const Int8 above = gather_bytes(image.data.data(), image.data.size(), at);
  const Int8 below = gather_bytes(image.data.data(), image.data.size(), at + image.width);
  const auto mixed = [](Float8 share, Float8 from, Float8 to) {
    return multiply_add(share, to - from, from);
  };
  return mixed(ay, mixed(ax, byte_of(above, 0), byte_of(above, 1)),
               mixed(ax, byte_of(below, 0), byte_of(below, 1)));
}

}  // namespace fusebench::simd
