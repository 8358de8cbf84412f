// All geometry that rays can hit: the scene, and the objects of faults.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "datasets/simulator/faults/fault.hpp"
#include "datasets/simulator/faults/hand.hpp"
#include "datasets/simulator/render/renderer.hpp"

namespace fusebench::simulator::faults {

struct Scenery {
  struct MovingHand {
    Hand hand;
    render::Renderer surface;
  };

  /// Holds only the objects that the faults require. color: camera that determines the size of hands.
  Scenery(const scene::SimulatedScene& scene, const PinholeCamera& color,
          std::span<const SimulatedFault> faults, std::uint64_t seed);

  render::Renderer scene;
  std::optional<render::Renderer> matt;          ///< shape of the scene in a uniform grey, without lighting
  std::vector<std::optional<MovingHand>> hands;  ///< by fault
  std::optional<render::Renderer> person;        ///< in its own frame
  double floor_m = 0;                            ///< z of the lowest point of the scene
};

}  // namespace fusebench::simulator::faults
