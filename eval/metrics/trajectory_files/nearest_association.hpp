// Pairs two trajectories by the rule of evo.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/trajectory/association.hpp"

namespace fusebench::trajectory_files {

/// The shorter list drives (the second, if both are as long): each of its stamps takes the nearest of the
/// other list, the first entry of equally near ones, if it is not further than max_difference_s (inclusive).
/// One stamp may serve several. offset_s is added to the second list's stamps. Differences are those of
/// seconds as doubles, so that a difference of just the limit falls as in evo (v1.36.5, sync.py).
///
/// Neither list need be sorted; the order of the pairs is that of the driving list. O(n log m), and a sort of
/// the longer list where it is not.
[[nodiscard]] std::vector<trajectory::AssociatedPair> associate_nearest(
    std::span<const std::int64_t> first_ns, std::span<const std::int64_t> second_ns, double max_difference_s,
    double offset_s = 0);

}  // namespace fusebench::trajectory_files
