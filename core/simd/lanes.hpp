// Eight numbers at once: vector types of the compiler with the usual operators, lane by lane. Each lane
// computes what a single number would, bit for bit, so that a build without these instructions gives the same
// results. The few things that have no operator are instructions where there are any, and loops elsewhere.
#pragma once

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace fusebench::simd {

inline constexpr std::size_t kLanes = 8;

using Float8 [[gnu::vector_size(32)]] = float;
using Int8 [[gnu::vector_size(32)]] =
    std::int32_t;  ///< also the result of a comparison: -1 = true, 0 = false

/// 0, 1, ..., 7.
inline constexpr Float8 kLaneNumber = {0, 1, 2, 3, 4, 5, 6, 7};

/// True if a comparison holds in any lane.
[[nodiscard]] inline bool any(Int8 condition) {
  using Long4 [[gnu::vector_size(32)]] = std::int64_t;
  const auto words = std::bit_cast<Long4>(condition);
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

/// Bit i is set if a comparison holds in lane i.
[[nodiscard]] inline unsigned lane_bits(Int8 condition) {
#ifdef __AVX2__
  return static_cast<unsigned>(_mm256_movemask_ps(std::bit_cast<__m256>(condition)));
#else
  unsigned bits = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) bits |= (condition[lane] != 0 ? 1U : 0U) << lane;
  return bits;
#endif
}

/// The same number in all lanes.
[[nodiscard]] inline Float8 all_lanes(float value) {
  return Float8{value, value, value, value, value, value, value, value};
}
[[nodiscard]] inline Int8 all_lanes(std::int32_t value) {
  return Int8{value, value, value, value, value, value, value, value};
}

/// As std::min and std::max: if one is not a number the result is `a`.
[[nodiscard]] inline Float8 min(Float8 a, Float8 b) { return b < a ? b : a; }
[[nodiscard]] inline Float8 max(Float8 a, Float8 b) { return a < b ? b : a; }
[[nodiscard]] inline Int8 min(Int8 a, Int8 b) { return b < a ? b : a; }
[[nodiscard]] inline Int8 max(Int8 a, Int8 b) { return a < b ? b : a; }
/// As std::clamp, but what is not a number becomes `low` (the order of operands sees to that), so that an
/// index made of the result is always one of the image.
[[nodiscard]] inline Float8 clamp(Float8 values, float low, float high) {
  return min(max(all_lanes(low), values), all_lanes(high));
}
[[nodiscard]] inline Float8 abs(Float8 values) {
  return std::bit_cast<Float8>(std::bit_cast<Int8>(values) & 0x7FFFFFFF);
}

/// a * b + c, rounded once, which is faster as well; always explicit, since compilers may not contract on
/// their own (-ffp-contract=off).
[[nodiscard]] inline Float8 multiply_add(Float8 a, Float8 b, Float8 c) {
#if defined(__AVX2__) && defined(__FMA__)
  return std::bit_cast<Float8>(
      _mm256_fmadd_ps(std::bit_cast<__m256>(a), std::bit_cast<__m256>(b), std::bit_cast<__m256>(c)));
#else
  Float8 result;
  for (std::size_t lane = 0; lane < kLanes; ++lane) result[lane] = std::fma(a[lane], b[lane], c[lane]);
  return result;
#endif
}
[[nodiscard]] inline Float8 multiply_add(float a, Float8 b, Float8 c) {
  return multiply_add(all_lanes(a), b, c);
}

/// Cuts the fraction off.
[[nodiscard]] inline Int8 to_int(Float8 values) { return __builtin_convertvector(values, Int8); }
[[nodiscard]] inline Float8 to_float(Int8 values) { return __builtin_convertvector(values, Float8); }

/// As std::floor, for numbers that an int can hold.
[[nodiscard]] inline Int8 floor_to_int(Float8 values) {
  const Int8 cut = to_int(values);
  return cut + (to_float(cut) > values);  // true is -1
}

/// As std::sqrt, for numbers from 0 on.
[[nodiscard]] inline Float8 sqrt(Float8 values) {
#ifdef __AVX2__
  return std::bit_cast<Float8>(_mm256_sqrt_ps(std::bit_cast<__m256>(values)));
#else
  Float8 result;
  for (std::size_t lane = 0; lane < kLanes; ++lane) result[lane] = std::sqrt(values[lane]);
  return result;
#endif
}

/// values[at] by lane.
[[nodiscard]] inline Float8 gather(const float* values, Int8 at) {
#ifdef __AVX2__
  return std::bit_cast<Float8>(_mm256_i32gather_ps(values, std::bit_cast<__m256i>(at), 4));
#else
  Float8 result;
  for (std::size_t lane = 0; lane < kLanes; ++lane) result[lane] = values[at[lane]];
  return result;
#endif
}

[[nodiscard]] inline Int8 gather(const std::int32_t* values, Int8 at) {
#ifdef __AVX2__
  return std::bit_cast<Int8>(_mm256_i32gather_epi32(values, std::bit_cast<__m256i>(at), 4));
#else
  Int8 result;
  for (std::size_t lane = 0; lane < kLanes; ++lane) result[lane] = values[at[lane]];
  return result;
#endif
}

/// The four bytes from bytes[at] on, by lane, the first one the lowest; bytes beyond the last of the `count`
/// >= 4 are unspecified.
[[nodiscard]] inline Int8 gather_bytes(const std::uint8_t* bytes, std::size_t count, Int8 at) {
  // Words of four bytes: the last one ends with the bytes, and what it begins too early is shifted out.
  const auto last = static_cast<std::int32_t>(count) - 4;
  const Int8 begin = at < last ? at : all_lanes(last);
#ifdef __AVX2__
  const auto words = std::bit_cast<Int8>(
      _mm256_i32gather_epi32(reinterpret_cast<const int*>(bytes), std::bit_cast<__m256i>(begin), 1));
#else
  static_assert(std::endian::native == std::endian::little);
  Int8 words;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    std::int32_t word = 0;
    std::memcpy(&word, bytes + begin[lane], sizeof(word));
    words[lane] = word;
  }
#endif
  return words >> (8 * (at - begin));
}

/// Eight values in a row, wherever they begin.
[[nodiscard]] inline Float8 load(const float* values) {
  Float8 result;
  std::memcpy(&result, values, sizeof(result));
  return result;
}
/// The sum of all lanes, in their order.
[[nodiscard]] inline double sum_of_lanes(Float8 values) {
  double sum = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) sum += static_cast<double>(values[lane]);
  return sum;
}

inline void store(Float8 values, float* target) { std::memcpy(target, &values, sizeof(values)); }

}  // namespace fusebench::simd
