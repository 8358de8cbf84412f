// A textured object that moves close to the camera, for example a hand.
#pragma once

#include <cstdint>

#include "core/base/types.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::faults {

/// A domed card with round corners and the aspect ratio of the image, 0.4 m in front of the colour camera. It
/// moves by up to 0.1 m horizontally and vertically, within the image.
class Hand {
 public:
  /// share: of the pixels of the colour image that it covers, without lens distortion.
  Hand(const PinholeCamera& color, double share, std::uint64_t seed);

  /// Mesh in its own frame: metres, the rim at z = 0, the dome towards -z.
  [[nodiscard]] scene::SimulatedScene surface() const;

  /// Pose in the colour camera's frame.
  [[nodiscard]] SE3 T_color_hand(double time_s) const;

 private:
  Vector2d half_m_ = Vector2d::Zero();
  Vector2d middle_m_ = Vector2d::Zero();  // of its path, in the colour camera
  Vector2d reach_m_ = Vector2d::Zero();
  double turn_rad_ = 0;
  Vector3d phase_rad_ = Vector3d::Zero();
  std::uint64_t seed_ = 0;
};

}  // namespace fusebench::simulator::faults
