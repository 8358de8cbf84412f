// Selects a heading with texture, since hand-held cameras rarely point at a blank wall.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>

#include "core/base/parallel.hpp"
#include "datasets/simulator/render/renderer.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::simulator::motion {

/// Amount of texture in the view of a level camera by heading (about world z, 0 is along x). The default is
/// uniform, so no heading is preferred.
struct HeadingTexture {
  static constexpr std::size_t kHeadings = 24;

  std::array<double, kHeadings> share{};  ///< share of image cells with an edge, 0 to 1, every 15 degrees
  std::optional<double> only_rad;         ///< the only useful heading; empty: by the texture
  std::optional<double> face_rad;  ///< mean heading, if the scene has a main side; empty: by the texture

  [[nodiscard]] double at(double heading_rad) const;  ///< interpolated, periodic

  /// Rotation about the vertical that maximises the texture of the worst tenth of the motion
  /// (T_world_camera); 0 if none is better.
  [[nodiscard]] double best_turn_rad(const synthetic_imu::PoseSpline& camera) const;
};

/// Measures the texture around the middle of the box.
[[nodiscard]] HeadingTexture look_around(const render::Renderer& renderer, const Eigen::AlignedBox3d& box,
                                         const Workers& workers);

/// Camera axes (x right, y down, z forward) for a heading and an upward pitch; world z up.
[[nodiscard]] Quaterniond looking(double heading_rad, double pitch_rad, double roll_rad);

}  // namespace fusebench::simulator::motion
