// Stamps of images in the lists of a recording, and dropped images.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fusebench::simulator::sensors {

/// Errors of a driver; without them, stamps are the capture instants.
struct StampErrors {
  double jitter_s = 0;       ///< standard deviation of a stamp (cut at 3.9 of them)
  double dropped_share = 0;  ///< share of randomly dropped images; the first one is never dropped

  [[nodiscard]] bool any() const { return jitter_s > 0 || dropped_share > 0; }
};

/// The images of one sensor.
struct ImageStamps {
  std::vector<std::int64_t> stamp_ns;
  std::vector<bool> dropped;
};

/// Random streams of the sensors, whose errors are independent.
enum class ImageStream : std::uint64_t { color = 1, depth = 2 };

/// Stamps of images captured at capture_ns, rounded to multiples of tick_ns. Deterministic.
[[nodiscard]] ImageStamps stamped(std::span<const std::int64_t> capture_ns, const StampErrors& errors,
                                  std::int64_t tick_ns, std::uint64_t seed, ImageStream stream);

}  // namespace fusebench::simulator::sensors
