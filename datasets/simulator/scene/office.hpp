// An office from a seed: a long desk with many objects, near enough for a depth camera that looks down on it.
#pragma once

#include <cstdint>

#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// About 5.4 x 4.8 x 2.7 m, floor at z = 0, origin in the middle of the floor, furniture along all walls. The
/// desk is at the wall towards +x: black monitors, keyboards, papers, books, cables and cups on a bright top,
/// with the contrast of TUM's freiburg1. Screens, plastic and enamel are glossy; two screens change their
/// content. free_space is in front of the desk and above its front edge; face_rad is towards the desk. The
/// same seed gives the same scene.
[[nodiscard]] SimulatedScene make_office(std::uint64_t seed);

}  // namespace fusebench::simulator::scene
