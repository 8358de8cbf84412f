// Codes of images by random ferns (Glocker et al., "Real-Time RGB-D Camera Relocalization via Randomized
// Ferns for Keyframe Encoding", 2015): each fern asks four yes-or-no questions about pixels of a small image,
// and images that answer alike show the same place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

namespace fusebench::ferns {

inline constexpr std::size_t kFerns = 500;
inline constexpr std::size_t kTestsOfFern = 4;

/// Of every fern one number: bit t is set if the image passes its test t.
using FernCode = std::array<std::uint8_t, kFerns>;

/// Records that the image passes this test, counted over all ferns: 0 to kFerns * kTestsOfFern - 1.
void pass(FernCode& code, std::size_t test);

/// Share of the ferns that differ, 0 to 1.
[[nodiscard]] double dissimilarity(const FernCode& a, const FernCode& b);

/// From 0 to below 1, the same on every machine.
[[nodiscard]] double uniform(std::mt19937_64& generator);

}  // namespace fusebench::ferns
