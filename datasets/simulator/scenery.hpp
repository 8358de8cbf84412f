// Everything that rays can meet: the scene, and what faults put in its place or before it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "datasets/simulator/fault.hpp"
#include "datasets/simulator/hand.hpp"
#include "datasets/simulator/renderer.hpp"

namespace fusebench {

struct Scenery {
  struct MovingHand {
    Hand hand;
    Renderer surface;
  };

  /// Holds what the faults need and no more. color: the camera that hands are measured by.
  Scenery(const SimulatedScene& scene, const PinholeCamera& color, std::span<const SimulatedFault> faults,
          std::uint64_t seed);

  Renderer scene;
  std::optional<Renderer> matt;                  ///< its shape in one grey, without light and shade
  std::vector<std::optional<MovingHand>> hands;  ///< by fault
};

}  // namespace fusebench
