// Number of image rows in a chunk of workers.
#pragma once

#include <cstddef>

namespace fusebench::baselines {

/// For results by pixel; any number gives the same bytes.
inline constexpr std::size_t kRowsAtOnce = 16;

/// For sums, which are reduced chunk by chunk. Another number changes the last digits.
inline constexpr std::size_t kRowsASum = 8;

}  // namespace fusebench::baselines
