// A room with an open rack full of small things, from a seed: what a camera sweeps over closely.
#pragma once

#include <cstdint>

#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// About 5 x 5 x 2.7 m, floor at z = 0, the origin in its middle. The rack fills the wall towards +x. Its
/// boards have no back, so that things of a few centimetres stand 5 to 50 cm before others and before the
/// wall; where they are, what they are and how they are painted comes from the seed. free_space is a slab
/// along the rack, 0.72 m and more from what reaches out farthest; heading_rad looks at the rack. The same
/// seed gives the same scene.
[[nodiscard]] SimulatedScene make_storage_room(std::uint64_t seed);

}  // namespace fusebench::simulator::scene
