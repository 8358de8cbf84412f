// A room from a seed with an open rack full of small objects, for a close sweep.
#pragma once

#include <cstdint>

#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// About 5 x 5 x 2.7 m, floor at z = 0, origin in the middle of the floor. The rack fills the wall towards
/// +x. Its boards have no back: objects of a few centimetres are 5 to 50 cm in front of others and of the
/// wall. Positions, kinds and textures depend on the seed. free_space is a slab along the rack, at least 0.72
/// m from the foremost object; heading_rad is towards the rack. The same seed gives the same scene.
[[nodiscard]] SimulatedScene make_storage_room(std::uint64_t seed);

}  // namespace fusebench::simulator::scene
