// Motion of a hand-held camera along a route.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "datasets/simulator/motion/motion.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::simulator::routes {

/// Motion of the colour camera (T_world_camera, world z up) along the route of a preset with
/// motion::follows_route(), with the sway and tremor of a hand. free_space: of the preset's scene with the
/// same seed. Speeds stay below the peaks of the options. A span shorter than the route shows its start; in a
/// longer one the camera rests at its end. Deterministic.
[[nodiscard]] synthetic_imu::PoseSpline route_motion(motion::MotionPreset preset,
                                                     const motion::MotionOptions& options,
                                                     const motion::MotionSpan& span,
                                                     const Eigen::AlignedBox3d& free_space,
                                                     std::uint64_t seed);

}  // namespace fusebench::simulator::routes
