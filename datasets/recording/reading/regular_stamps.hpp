// Capture times from jittering stamps. A free-running camera exposes at a constant rate, but a driver stamps
// its images when they arrive: TUM's colour stamps jitter by 1.8 ms rms (4.7 ms at worst), which at 100 deg/s
// is half a degree.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fusebench::reading {

struct RegularStamps {
  std::vector<std::int64_t> capture_ns;  ///< one a stamp, strictly increasing
  double jitter_rms_s = 0;               ///< of the stamps against them
  double jitter_max_s = 0;
};

/// Times on a line fitted to the stamps of half a second before and after each image, by frame number (a gap
/// of n periods is n frames, so dropped images do no harm). Nothing if the stamps are too few (below 10) or
/// not those of a constant rate (some stamp is more than half a period off its line).
[[nodiscard]] std::optional<RegularStamps> regular_stamps(std::span<const std::int64_t> stamps_ns);

}  // namespace fusebench::reading
