// Codes of images by random ferns (Glocker et al., "Real-Time RGB-D Camera Relocalization via Randomized
// Ferns for Keyframe Encoding", 2015). Each fern has four binary tests on pixels of a small image. Images
// with similar codes show the same place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

namespace fusebench::ferns {

inline constexpr std::size_t kFerns = 500;
inline constexpr std::size_t kTestsOfFern = 4;

/// One number for each fern: bit t is set if the image passes test t.
using FernCode = std::array<std::uint8_t, kFerns>;

/// Sets the bit of a passed test. test: index over all ferns, 0 to kFerns * kTestsOfFern - 1.
void pass(FernCode& code, std::size_t test);

/// Share of the ferns that differ, 0 to 1.
[[nodiscard]] double dissimilarity(const FernCode& a, const FernCode& b);

/// Uniform in [0, 1), identical on all machines.
[[nodiscard]] double uniform(std::mt19937_64& generator);

}  // namespace fusebench::ferns
