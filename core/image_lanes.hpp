// Grey levels at eight places of an image at once.
#pragma once

#include <array>

#include "core/image.hpp"
#include "core/lanes.hpp"

namespace fusebench {

/// As IntensitySample.
struct IntensityLanes {
  Float8 value{};
  Float8 dx{};
  Float8 dy{};
};

namespace lane_details {

/// Byte number `at` of each word.
[[nodiscard]] inline Float8 byte_of(Int8 words, int at) { return to_float((words >> (8 * at)) & 0xFF); }

/// Weights of the four pixels around a place between the second and the third.
[[nodiscard]] inline std::array<Float8, 4> cubic_weights(Float8 t) {
  return {t * (-0.5F + t * (1.0F - 0.5F * t)), 1.0F + t * t * (-2.5F + 1.5F * t),
          t * (0.5F + t * (2.0F - 1.5F * t)), t * t * (-0.5F + 0.5F * t)};
}
/// Their derivatives.
[[nodiscard]] inline std::array<Float8, 4> cubic_slopes(Float8 t) {
  return {-0.5F + t * (2.0F - 1.5F * t), t * (-5.0F + 4.5F * t), 0.5F + t * (4.0F - 4.5F * t),
          t * (-1.0F + 1.5F * t)};
}

[[nodiscard]] inline Float8 weighted(const std::array<Float8, 4>& weights,
                                     const std::array<Float8, 4>& values) {
  return weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2] + weights[3] * values[3];
}

/// The four pixels of a row of the image from each place on.
[[nodiscard]] inline std::array<Float8, 4> four_pixels(const GreyImage& image, Int8 at) {
  const Int8 words = gather_bytes(image.data.data(), image.data.size(), at);
  return {byte_of(words, 0), byte_of(words, 1), byte_of(words, 2), byte_of(words, 3)};
}

}  // namespace lane_details

/// As the other sample_bicubic. Needs 1 <= x <= width - 2 (same for y) in all lanes.
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
    sample.value += down[row] * value;
    sample.dx += down[row] * weighted(across_slopes, pixels);
    sample.dy += down_slopes[row] * value;
  }
  return sample;
}

/// The value of it alone.
[[nodiscard]] inline Float8 sample_bicubic_value(const GreyImage& image, Float8 x, Float8 y) {
  using namespace lane_details;
  const Int8 left = min(to_int(x), all_lanes(image.width - 3));
  const Int8 top = min(to_int(y), all_lanes(image.height - 3));
  const auto across = cubic_weights(x - to_float(left));
  const auto down = cubic_weights(y - to_float(top));
  Float8 value{};
  Int8 at = (top - 1) * image.width + left - 1;
  for (std::size_t row = 0; row < 4; ++row, at += image.width) {
    value += down[row] * weighted(across, four_pixels(image, at));
  }
  return value;
}

/// Value of the other sample_bilinear. Needs 0 <= x <= width - 1 (same for y) in all lanes.
[[nodiscard]] inline Float8 sample_bilinear_value(const GreyImage& image, Float8 x, Float8 y) {
  using lane_details::byte_of;
  const Int8 left = min(to_int(x), all_lanes(image.width - 2));
  const Int8 top = min(to_int(y), all_lanes(image.height - 2));
  const Float8 ax = x - to_float(left);
  const Float8 ay = y - to_float(top);
  const Int8 at = top * image.width + left;
  const Int8 above = gather_bytes(image.data.data(), image.data.size(), at);
  const Int8 below = gather_bytes(image.data.data(), image.data.size(), at + image.width);
  const Float8 upper = byte_of(above, 0) + ax * (byte_of(above, 1) - byte_of(above, 0));
  const Float8 lower = byte_of(below, 0) + ax * (byte_of(below, 1) - byte_of(below, 0));
  return upper + ay * (lower - upper);
}

}  // namespace fusebench
