// Vectors of eight numbers: vector types of the compiler with operators by lane. Each lane gives the same
// bits as scalar code, so builds without these instructions give the same results. Functions without an
// operator use instructions if available, otherwise loops.
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

/// As std::min and std::max; the result is `a` if an argument is NaN.
[[nodiscard]] inline Float8 min(Float8 a, Float8 b) { return b < a ? b : a; }
[[nodiscard]] inline Float8 max(Float8 a, Float8 b) { return a < b ? b : a; }
[[nodiscard]] inline Int8 min(Int8 a, Int8 b) { return b < a ? b : a; }
[[nodiscard]] inline Int8 max(Int8 a, Int8 b) { return a < b ? b : a; }
/// As std::clamp, but NaN becomes `low` (by the order of operands), so an index computed from the result is
/// always valid.
[[nodiscard]] inline Float8 clamp(Float8 values, float low, float high) {
  return min(max(all_lanes(low), values), all_lanes(high));
}
[[nodiscard]] inline Float8 abs(Float8 values) {
  return std::bit_cast<Float8>(std::bit_cast<Int8>(values) & 0x7FFFFFFF);
}

/// a * b + c with one rounding. Always explicit, since compilers may not contract (-ffp-contract=off).
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

/// Truncates towards zero.
[[nodiscard]] inline Int8 to_int(Float8 values) { return __builtin_convertvector(values, Int8); }
[[nodiscard]] inline Float8 to_float(Int8 values) { return __builtin_convertvector(values, Float8); }

/// As std::floor, for values in the range of int.
[[nodiscard]] inline Int8 floor_to_int(Float8 values) {
  const Int8 cut = to_int(values);
  return cut + (to_float(cut) > values);  // true is -1
}

/// As std::sqrt, for values >= 0.
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

/// The four bytes from bytes[at] on, by lane, first byte lowest. Bytes at or beyond `count` (>= 4) are
/// unspecified.
[[nodiscard]] inline Int8 gather_bytes(const std::uint8_t* bytes, std::size_t count, Int8 at) {
  // Reads words of four bytes. The last word ends with the array; bytes before the requested position are
  // shifted out.
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

/// Loads eight consecutive values (no alignment required).
[[nodiscard]] inline Float8 load(const float* values) {
  Float8 result;
  std::memcpy(&result, values, sizeof(result));
  return result;
}
/// The sum of all lanes in a fixed order.
[[nodiscard]] inline double sum_of_lanes(Float8 values) {
  double sum = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) sum += static_cast<double>(values[lane]);
  return sum;
}

inline void store(Float8 values, float* target) { std::memcpy(target, &values, sizeof(values)); }

}  // namespace fusebench::simd
