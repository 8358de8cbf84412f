// A long corridor with few objects on its walls.
#pragma once

#include <cstdint>

#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// The corridor is along the x axis from x = 0, floor at z = 0, middle at y = 0.
struct CorridorShape {
  static constexpr double kLength_m = 28.0;
  static constexpr double kWidth_m = 2.0;
  static constexpr double kHeight_m = 2.6;
};

/// Painted walls and a finely speckled floor, with a closed door, a picture or a notice every 2 to 4 m on
/// either side: sparse, repetitive texture. free_space is in the first half, at the height of hand-held
/// cameras. The same seed gives the same scene.
[[nodiscard]] SimulatedScene make_corridor(std::uint64_t seed);

}  // namespace fusebench::simulator::scene
