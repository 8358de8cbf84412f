// A person who walks across the view.
#pragma once

#include <cstdint>

#include "core/base/types.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::faults {

/// A rigid figure of ellipsoids, 1.75 m tall (arms and legs do not swing). Own frame: metres, z up, the floor
/// at z = 0, x forward.
[[nodiscard]] scene::SimulatedScene person_surface(std::uint64_t seed);

/// A straight walk on the floor across the view of a camera, at 1 m/s, with the vertical motion of the steps.
class PersonWalk {
 public:
  /// T_world_camera: pose of the camera at `middle_s`, when the person passes in front of it; world with z
  /// up. distance_m: horizontal distance to the camera at that time. floor_m: z of the floor.
  PersonWalk(const SE3& T_world_camera, double middle_s, double distance_m, double floor_m);

  [[nodiscard]] SE3 T_world_person(double time_s) const;

 private:
  Vector3d middle_m_ = Vector3d::Zero();  // position at middle_s
  Vector3d along_ = Vector3d::UnitX();    // horizontal unit vector
  double middle_s_ = 0;
};

}  // namespace fusebench::simulator::faults
