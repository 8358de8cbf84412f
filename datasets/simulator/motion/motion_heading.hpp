// Choice of a heading with texture: hand-held cameras are rarely pointed at a blank wall.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>

#include "core/base/parallel.hpp"
#include "datasets/simulator/render/renderer.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::simulator::motion {

/// Amount of texture in view of a level camera, by heading (about world z, 0 looks along x). A default one is
/// the same everywhere, so that nothing is preferred.
struct HeadingTexture {
  static constexpr std::size_t kHeadings = 24;

  std::array<double, kHeadings>
      share{};                     ///< of the image's cells that hold an edge, 0 to 1, every 15 degrees
  std::optional<double> only_rad;  ///< the one heading that is worth looking at; empty: by the texture
  std::optional<double>
      face_rad;  ///< the mean heading, where a scene has a side to face; empty: by the texture

  [[nodiscard]] double at(double heading_rad) const;  ///< interpolated, periodic

  /// The turn about the vertical, of a motion of a camera (T_world_camera), for which the tenth of the time
  /// with the least texture has the most of it; 0 if none is better.
  [[nodiscard]] double best_turn_rad(const synthetic_imu::PoseSpline& camera) const;
};

/// Looks around from the middle of the box.
[[nodiscard]] HeadingTexture look_around(const render::Renderer& renderer, const Eigen::AlignedBox3d& box,
                                         const Workers& workers);

/// Camera axes (x right, y down, z forward) that look along a heading, raised by the pitch; world z up.
[[nodiscard]] Quaterniond looking(double heading_rad, double pitch_rad, double roll_rad);

}  // namespace fusebench::simulator::motion
