// A person who walks through the view.
#pragma once

#include <cstdint>

#include "core/base/types.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::faults {

/// A clothed figure, 1.75 m tall, of ellipsoids that do not move against each other (arms and legs do not
/// swing). In its own frame: metres, z up, the floor at z = 0, x the way it faces.
[[nodiscard]] scene::SimulatedScene person_surface(std::uint64_t seed);

/// A straight walk on the floor, across the view of a camera, at 1 m/s, with the rise and fall of its steps.
class PersonWalk {
 public:
  /// T_world_camera: the camera that it passes before at `middle_s`, in a world with z up. distance_m: from
  /// the camera then, level. floor_m: z of the floor.
  PersonWalk(const SE3& T_world_camera, double middle_s, double distance_m, double floor_m);

  [[nodiscard]] SE3 T_world_person(double time_s) const;

 private:
  Vector3d middle_m_ = Vector3d::Zero();  // where it is at middle_s
  Vector3d along_ = Vector3d::UnitX();    // unit vector, level
  double middle_s_ = 0;
};

}  // namespace fusebench::simulator::faults
