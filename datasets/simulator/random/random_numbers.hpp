// Counter-based random numbers: a function of their purpose (seed, frame, pixel), not of the order of
// drawing. Identical for any number of threads and any standard library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fusebench::simulator::random {

/// Finaliser of SplitMix64 (Steele et al., OOPSLA 2014): each input bit affects all output bits.
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// 64 random bits for a counter under a key. Keys are nested: mix_key(mix_key(seed, frame), purpose).
[[nodiscard]] constexpr std::uint64_t mix_key(std::uint64_t key, std::uint64_t counter) {
  return mix_bits(key ^ mix_bits(counter));
}

/// Uniform in [0, 1), from the upper bits.
[[nodiscard]] constexpr double unit_interval(std::uint64_t bits) {
  return 0x1p-53 * static_cast<double>(bits >> 11);
}

/// Sequential numbers under a key, for data that is built in a fixed order (a room).
class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t key) : key_(key) {}

  [[nodiscard]] std::uint64_t bits() { return mix_key(key_, counter_++); }
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * unit_interval(bits()); }
  /// Uniform integer, 0 to count - 1.
  [[nodiscard]] int below(int count) { return static_cast<int>(uniform(0, count)); }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

/// Standard normal numbers by the tabulated inverse distribution function: tails end at 3.9 standard
/// deviations, the standard deviation is 1 within 1e-3.
class NormalTable {
 public:
  static const NormalTable& instance();

  /// Uses the lower 21 bits.
  [[nodiscard]] float operator()(std::uint64_t bits) const {
    const auto cell = static_cast<std::size_t>((bits >> 9) & 4095U);
    const float fraction = static_cast<float>(bits & 511U) * (1.0F / 512.0F);
    return quantile_[cell] + fraction * (quantile_[cell + 1] - quantile_[cell]);
  }
  /// Three independent numbers from 63 bits.
  [[nodiscard]] std::array<float, 3> triple(std::uint64_t bits) const {
    return {(*this)(bits), (*this)(bits >> 21), (*this)(bits >> 42)};
  }

 private:
  NormalTable();
  std::array<float, 4097> quantile_{};
};

}  // namespace fusebench::simulator::random
