// What the lists of a recording say about when its images were taken, and which of them are there at all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fusebench::simulator::sensors {

/// Errors of a driver; with none of them stamps are the instants of capture.
struct StampErrors {
  double jitter_s = 0;       ///< standard deviation of a stamp about its capture (at most 3.9 of them)
  double dropped_share = 0;  ///< of the images that never arrive, each by chance; the first one always does

  [[nodiscard]] bool any() const { return jitter_s > 0 || dropped_share > 0; }
};

/// The images of one sensor.
struct ImageStamps {
  std::vector<std::int64_t> stamp_ns;
  std::vector<bool> dropped;
};

/// Which sensor, so that two of them err independently.
enum class ImageStream : std::uint64_t { color = 1, depth = 2 };

/// Stamps of images that are captured at capture_ns, rounded to multiples of tick_ns. The same arguments give
/// the same stamps.
[[nodiscard]] ImageStamps stamped(std::span<const std::int64_t> capture_ns, const StampErrors& errors,
                                  std::int64_t tick_ns, std::uint64_t seed, ImageStream stream);

}  // namespace fusebench::simulator::sensors
