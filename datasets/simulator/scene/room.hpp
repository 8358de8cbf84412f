// A furnished room from a seed.
#pragma once

#include <cstdint>

#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// About 5 x 5 x 2.8 m, floor at z = 0, the origin in its middle. One wall has books (clutter), one a desk
/// before bricks or wallpaper (repetitive), one is plain paint around a door (nothing to track), one has a
/// sofa, a window and a shelf of equal jars; their order, colours and details come from the seed. free_space
/// is empty, in the middle of the room at the height of hand-held cameras; look_at spans what stands in the
/// room. The same seed gives the same scene.
[[nodiscard]] SimulatedScene make_room(std::uint64_t seed);

}  // namespace fusebench::simulator::scene
