// Iteration over the bits of an integer.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>

namespace fusebench {
inline namespace base {

/// Calls use(i) for each set bit i, lowest first.
template <std::unsigned_integral Bits, class Use>
void for_each_bit(Bits bits, const Use& use) {
  for (; bits != 0; bits &= bits - 1) use(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace base
}  // namespace fusebench
