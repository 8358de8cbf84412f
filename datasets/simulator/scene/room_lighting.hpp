// Computes the light at each vertex of a scene.
#pragma once

#include <vector>

#include "core/base/geometry.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// A small lamp: at distance d, a surface that faces it receives strength / d^2.
struct Lamp {
  Vector3d position;
  double strength = 1;
};

/// Multiplies the light of the scene by the light at each vertex: an ambient term with occlusion by surfaces
/// within 1.2 m, and lamps with soft shadows. Requires normals. Light does not depend on the view.
void bake_light(SimulatedScene& scene, const std::vector<Lamp>& lamps, double ambient);

}  // namespace fusebench::simulator::scene
