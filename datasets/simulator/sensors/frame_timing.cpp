#include "datasets/simulator/sensors/frame_timing.hpp"

#include <cmath>

#include "datasets/simulator/random/random_numbers.hpp"

namespace fusebench::simulator::sensors {

namespace {

constexpr std::uint64_t kTiming = 0x71;  // key of an independent random stream

}  // namespace

ImageStamps stamped(std::span<const std::int64_t> capture_ns, const StampErrors& errors, std::int64_t tick_ns,
                    std::uint64_t seed, ImageStream stream) {
  const std::uint64_t key =
      random::mix_key(random::mix_key(seed, kTiming), static_cast<std::uint64_t>(stream));
  const random::NormalTable& normal = random::NormalTable::instance();
  ImageStamps images;
  for (std::size_t k = 0; k < capture_ns.size(); ++k) {
    const double late_s =
        errors.jitter_s * static_cast<double>(normal(random::mix_key(random::mix_key(key, 1), k)));
    const std::int64_t late_ticks = std::llround(1e9 * late_s / static_cast<double>(tick_ns));
    images.stamp_ns.push_back(capture_ns[k] + late_ticks * tick_ns);
    const double chance = random::unit_interval(random::mix_key(random::mix_key(key, 2), k));
    images.dropped.push_back(k > 0 && chance < errors.dropped_share);
  }
  return images;
}

}  // namespace fusebench::simulator::sensors
