// A textured object that moves close to the camera, such as a hand or a passer-by.
#pragma once

#include <cstdint>

#include "core/base/types.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::faults {

/// A domed card with round corners and the proportions of the image, 0.4 m before the colour camera. It moves
/// up to 0.1 m from side to side and up and down, as far as it stays in the image.
class Hand {
 public:
  /// share: of the pixels of the colour image that it covers, lens distortion apart.
  Hand(const PinholeCamera& color, double share, std::uint64_t seed);

  /// In its own frame: metres, the rim at z = 0, the dome towards -z.
  [[nodiscard]] scene::SimulatedScene surface() const;

  /// Where it is, in the colour camera's frame.
  [[nodiscard]] SE3 T_color_hand(double time_s) const;

 private:
  Vector2d half_m_ = Vector2d::Zero();
  Vector2d middle_m_ = Vector2d::Zero();  // of its way, in the colour camera
  Vector2d reach_m_ = Vector2d::Zero();
  double turn_rad_ = 0;
  Vector3d phase_rad_ = Vector3d::Zero();
  std::uint64_t seed_ = 0;
};

}  // namespace fusebench::simulator::faults
