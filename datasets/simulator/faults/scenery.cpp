#include "datasets/simulator/faults/scenery.hpp"

#include <algorithm>
#include <limits>

#include "datasets/simulator/faults/person.hpp"

namespace fusebench::simulator::faults {

namespace {

scene::SimulatedScene without_colors(const scene::SimulatedScene& scene) {
  scene::SimulatedScene plain;
  plain.mesh.vertices = scene.mesh.vertices;
  plain.mesh.triangles = scene.mesh.triangles;
  return plain;
}

double lowest_z_m(const scene::SimulatedScene& scene) {
  float lowest_m = std::numeric_limits<float>::infinity();
  for (const Eigen::Vector3f& vertex : scene.mesh.vertices) lowest_m = std::min(lowest_m, vertex.z());
  return lowest_m;
}

}  // namespace

Scenery::Scenery(const scene::SimulatedScene& scene_in, const PinholeCamera& color,
                 std::span<const SimulatedFault> faults, std::uint64_t seed)
    : scene(scene_in), hands(faults.size()) {
  const auto is_plain = [](const SimulatedFault& fault) { return fault.kind == FaultKind::no_texture; };
  if (std::ranges::any_of(faults, is_plain)) matt.emplace(without_colors(scene_in));
  const auto is_person = [](const SimulatedFault& fault) { return fault.kind == FaultKind::person; };
  if (std::ranges::any_of(faults, is_person)) {
    person.emplace(person_surface(seed));
    floor_m = lowest_z_m(scene_in);
  }
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (faults[i].kind != FaultKind::hand) continue;
    const Hand hand(color, faults[i].amount, seed);
    hands[i].emplace(MovingHand{hand, render::Renderer(hand.surface())});
  }
}

}  // namespace fusebench::simulator::faults
