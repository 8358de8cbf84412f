// Eight 16-bit numbers in memory (IEEE 754 binary16: eleven significant bits).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <Eigen/Core>

#include "core/base/simd/lanes.hpp"

namespace fusebench::simd {

using Half = Eigen::half;
static_assert(sizeof(Half) == 2);

#if defined(__AVX2__) && defined(__F16C__)
#define FUSEBENCH_HAS_HALF_INSTRUCTIONS
#endif

/// Loads eight consecutive values.
[[nodiscard]] inline Float8 load(const Half* values) {
#ifdef FUSEBENCH_HAS_HALF_INSTRUCTIONS
  __m128i row;
  std::memcpy(&row, values, sizeof(row));
  return std::bit_cast<Float8>(_mm256_cvtph_ps(row));
#else
  Float8 result;
  for (std::size_t lane = 0; lane < kLanes; ++lane) result[lane] = static_cast<float>(values[lane]);
  return result;
#endif
}

/// Rounds to the nearest, ties to even.
inline void store(Float8 values, Half* target) {
#ifdef FUSEBENCH_HAS_HALF_INSTRUCTIONS
  const __m128i row = _mm256_cvtps_ph(std::bit_cast<__m256>(values), _MM_FROUND_TO_NEAREST_INT);
  std::memcpy(static_cast<void*>(target), &row, sizeof(row));
#else
  for (std::size_t lane = 0; lane < kLanes; ++lane) target[lane] = Half(values[lane]);
#endif
}

/// Two neighbours in memory, by lane.
struct Pairs {
  Float8 first;
  Float8 second;
};

/// values[at] and values[at + 1] by lane, with one load each.
[[nodiscard]] inline Pairs gather_pairs(const Half* values, Int8 at) {
#ifdef FUSEBENCH_HAS_HALF_INSTRUCTIONS
  const __m256i words =
      _mm256_i32gather_epi32(reinterpret_cast<const int*>(values), std::bit_cast<__m256i>(at), sizeof(Half));
  const __m256i first = _mm256_and_si256(words, _mm256_set1_epi32(0xFFFF));
  const __m256i second = _mm256_srli_epi32(words, 16);
  // Packing works within register halves, so the middle quarters are swapped.
  const __m256i packed = _mm256_permute4x64_epi64(_mm256_packus_epi32(first, second), 0b11'01'10'00);
  return {std::bit_cast<Float8>(_mm256_cvtph_ps(_mm256_castsi256_si128(packed))),
          std::bit_cast<Float8>(_mm256_cvtph_ps(_mm256_extracti128_si256(packed, 1)))};
#else
  Pairs result;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    result.first[lane] = static_cast<float>(values[at[lane]]);
    result.second[lane] = static_cast<float>(values[at[lane] + 1]);
  }
  return result;
#endif
}

/// values[at] by lane; values[at + 1] must be readable.
[[nodiscard]] inline Float8 gather(const Half* values, Int8 at) { return gather_pairs(values, at).first; }

#undef FUSEBENCH_HAS_HALF_INSTRUCTIONS

}  // namespace fusebench::simd
