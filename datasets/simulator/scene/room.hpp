// A furnished room from a seed.
#pragma once

#include <cstdint>

#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// About 5 x 5 x 2.8 m, floor at z = 0, origin in the middle of the floor. One wall has books (clutter), one
/// a desk before bricks or wallpaper (repetitive), one is plain paint around a door (no texture), one has a
/// sofa, a window and a shelf of equal jars; order, colours and details depend on the seed. free_space is
/// empty, in the middle of the room at the height of hand-held cameras; look_at contains the furniture. The
/// same seed gives the same scene.
[[nodiscard]] SimulatedScene make_room(std::uint64_t seed);

}  // namespace fusebench::simulator::scene
