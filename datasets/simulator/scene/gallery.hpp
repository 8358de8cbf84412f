// A long hall with furniture along one side, for a path without repeated views.
#pragma once

#include <cstdint>

#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// The hall is along the x axis from x = 0, floor at z = 0. The furnished wall is at y = kFurnishedWall_m.
struct GalleryShape {
  static constexpr int kSections = 8;
  static constexpr double kSection_m = 5.0;
  static constexpr double kLength_m = kSections * kSection_m;
  static constexpr double kFurnishedWall_m = 1.75;
  static constexpr double kOppositeWall_m = -1.25;
  static constexpr double kHeight_m = 2.75;
};

/// Sections of 5 m, each with its own textures and furniture: books, a desk or a sofa. free_space is in front
/// of the first sections, at the height of hand-held cameras. The same seed gives the same scene.
[[nodiscard]] SimulatedScene make_gallery(std::uint64_t seed);

}  // namespace fusebench::simulator::scene
