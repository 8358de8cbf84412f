// Pairs the entries of two time-stamped lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fusebench::trajectory {

struct AssociatedPair {
  std::size_t first = 0;   ///< index into the first list
  std::size_t second = 0;  ///< index into the second list
};

/// The rule of TUM's associate.py: of all pairs with |first - (second + offset)| < max_difference_ns
/// (strictly), take the closest first (equal ones by the earlier first, then second stamp), each entry at
/// most once. Both lists are sorted; of equal stamps the earlier entry is taken first. Returns pairs in the
/// order of the first list. O(n log n) time and O(n) memory, for any limit.
[[nodiscard]] std::vector<AssociatedPair> associate(std::span<const std::int64_t> first_ns,
                                                    std::span<const std::int64_t> second_ns,
                                                    std::int64_t max_difference_ns,
                                                    std::int64_t offset_ns = 0);

}  // namespace fusebench::trajectory
