// How the rows of an image are handed to workers.
#pragma once

#include <cstddef>

namespace fusebench::systems {

/// Where every pixel's result is its own, so that any number gives the same bytes.
inline constexpr std::size_t kRowsAtOnce = 16;

/// Where results are summed: those of so many rows first, then these sums. Another number moves last digits.
inline constexpr std::size_t kRowsASum = 8;

}  // namespace fusebench::systems
