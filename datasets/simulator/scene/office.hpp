// An office from a seed: a long desk full of things, near enough for a depth camera that looks down on it.
#pragma once

#include <cstdint>

#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// About 5.4 x 4.8 x 2.7 m, floor at z = 0, the origin in its middle, walls with furniture all around. The
/// desk stands at the wall towards +x: black monitors, keyboards, papers, books, cables, cups on a bright
/// top, of the contrast of TUM's freiburg1. Screens, plastic and enamel are glossy; two screens change what
/// they show. free_space is before the desk and above its front edge; face_rad looks at the desk. The
/// same seed gives the same scene.
[[nodiscard]] SimulatedScene make_office(std::uint64_t seed);

}  // namespace fusebench::simulator::scene
