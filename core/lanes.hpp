// Eight numbers at once: vector types of the compiler with the usual operators, lane by lane. Each lane
// computes what a single number would, bit for bit.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace fusebench {

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

/// The same number in all lanes.
[[nodiscard]] inline Float8 all_lanes(float value) { return Float8{} + value; }

/// As std::min and std::max.
[[nodiscard]] inline Float8 min(Float8 a, Float8 b) { return b < a ? b : a; }
[[nodiscard]] inline Float8 max(Float8 a, Float8 b) { return a < b ? b : a; }

/// Cuts the fraction off.
[[nodiscard]] inline Int8 to_int(Float8 values) { return __builtin_convertvector(values, Int8); }

/// values[at] by lane.
[[nodiscard]] inline Float8 gather(const float* values, Int8 at) {
  Float8 result;
  for (std::size_t lane = 0; lane < kLanes; ++lane) result[lane] = values[at[lane]];
  return result;
}

}  // namespace fusebench
