// Scenes with a closed form: exact depth images, distances and normals to hold reconstructions against.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench {

/// A solid ball, seen from outside.
struct AnalyticSphere {
  Vector3d center_world = Vector3d::Zero();
  double radius_m = 1.0;
  Rgb color = {200, 200, 200};
};

/// An axis-aligned box: solid and seen from outside, or (inside_out) the walls of a room seen from inside.
struct AnalyticBox {
  Vector3d min_world = Vector3d::Constant(-0.5);
  Vector3d max_world = Vector3d::Constant(0.5);
  bool inside_out = false;
  Rgb color = {200, 200, 200};
};

/// The half space normal . p < offset is solid; the normal is unit and points into free space.
struct AnalyticPlane {
  Vector3d normal_world = Vector3d(0, 0, -1);
  double offset_m = -1.0;
  Rgb color = {200, 200, 200};
};

using AnalyticShape = std::variant<AnalyticSphere, AnalyticBox, AnalyticPlane>;

struct AnalyticHit {
  double distance_m = 0;  ///< along the unit direction
  Vector3d normal_world = Vector3d::Zero();
  Rgb color{};
};

/// A union of solids.
struct AnalyticScene {
  std::vector<AnalyticShape> shapes;

  /// The first surface that the ray from origin along a unit direction enters from free space (back faces do
  /// not count).
  [[nodiscard]] std::optional<AnalyticHit> intersect(const Vector3d& origin_world,
                                                     const Vector3d& direction_world) const;

  /// Signed distance to the nearest surface, metres, positive in free space (exact outside of solids; inside,
  /// that of the nearest surface of each solid alone).
  [[nodiscard]] double distance_m(const Vector3d& point_world) const;

  /// Unit gradient of distance_m by central differences over +-1e-6 m.
  [[nodiscard]] Vector3d normal_at(const Vector3d& point_world) const;

  /// Noise-free depth and colour through the centre of each pixel; 0 where nothing is hit or the surface is
  /// seen at more than max_incidence_deg between ray and normal, as the gates of the pipeline would do.
  [[nodiscard]] RgbdFrame render(const PinholeCamera& camera, const SE3& T_world_camera,
                                 double max_incidence_deg = 75.0) const;
};

/// A camera with square pixels and the given horizontal field of view.
[[nodiscard]] PinholeCamera test_camera(int width_px, int height_px, double field_of_view_deg);

/// Pose of a camera at `eye` whose optical axis goes through `target`.
[[nodiscard]] SE3 look_at(const Vector3d& eye_world, const Vector3d& target_world);

/// Poses spread evenly over a sphere (Fibonacci lattice), all looking at its centre.
[[nodiscard]] std::vector<SE3> poses_around(const Vector3d& center_world, double distance_m, int count);

/// Poses at one place that look into the directions of a Fibonacci lattice.
[[nodiscard]] std::vector<SE3> poses_looking_out(const Vector3d& eye_world, int count);

}  // namespace fusebench
