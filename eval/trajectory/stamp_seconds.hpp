// Stamps as the doubles that scripts compare.
#pragma once

#include <cstdint>

namespace fusebench {

/// The double nearest to the decimal stamp, as if its text had been read. At today's epochs that is a grid of
/// a quarter of a microsecond, which decides what lies just at a limit.
[[nodiscard]] inline double stamp_seconds(std::int64_t stamp_ns) {
  return static_cast<double>(static_cast<long double>(stamp_ns) / 1e9L);
}

}  // namespace fusebench
