// The light that reaches each vertex of a scene.
#pragma once

#include <vector>

#include "core/base/geometry.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// A small lamp: at distance d, a surface that faces it gets strength / d^2.
struct Lamp {
  Vector3d position;
  double strength = 1;
};

/// Multiplies the scene's light by what reaches each vertex: an ambient term that the surroundings within 1.2
/// m shield, and lamps with soft shadows. Needs normals. Light does not depend on the view.
void bake_light(SimulatedScene& scene, const std::vector<Lamp>& lamps, double ambient);

}  // namespace fusebench::simulator::scene
