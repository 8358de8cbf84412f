// The motion of a hand-held camera along a route.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "datasets/simulator/motion/motion.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::simulator::routes {

/// The motion of the colour camera (T_world_camera, world z up) along the route of a preset for which
/// motion::follows_route() holds, with the sway and the tremor of a hand. free_space is that of the preset's
/// scene of the same seed. Speeds stay below the peaks of the options. A span that is shorter than the route
/// shows its beginning; in a longer one the camera is held at its end. The same arguments give the same
/// motion.
[[nodiscard]] synthetic_imu::PoseSpline route_motion(motion::MotionPreset preset,
                                                     const motion::MotionOptions& options,
                                                     const motion::MotionSpan& span,
                                                     const Eigen::AlignedBox3d& free_space,
                                                     std::uint64_t seed);

}  // namespace fusebench::simulator::routes
