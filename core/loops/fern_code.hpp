// What a place looks like from afar: random tests on a small image of colour and depth (Glocker et al.,
// "Real-Time RGB-D Camera Relocalization via Randomized Ferns for Keyframe Encoding", 2015). An image of 80
// pixels in width hardly changes by motion blur that leaves no corner in one of 640.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/image.hpp"

namespace fusebench::loops {

/// Of every fern one number: which of its four tests (red, green, blue, depth) the image passes.
inline constexpr std::size_t kFerns = 500;
using FernCode = std::array<std::uint8_t, kFerns>;

/// Share of the ferns that differ, 0 to 1.
[[nodiscard]] double dissimilarity(const FernCode& a, const FernCode& b);

/// color and depth_m (0 = no measurement) have one size, at least 80x60. Brightness drops out: colour counts
/// against the mean of the image. Tests are the same in every run and on every machine.
[[nodiscard]] FernCode fern_code(const ColorImage& color, const DepthImage& depth_m);

}  // namespace fusebench::loops
