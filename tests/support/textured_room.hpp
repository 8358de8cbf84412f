// A small textured room in closed form, for tests of the estimator: exact depth, noise-free colour.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::testing {

/// A box seen from inside (the room) with boxes in it, painted by a fixed sum of sines in 3D, and rendered by
/// ray casting.
struct TexturedRoom {
  Eigen::AlignedBox3d room{Vector3d(-1.6, -1.2, -1.0), Vector3d(1.7, 1.1, 2.6)};
  std::vector<Eigen::AlignedBox3d> furniture{
      Eigen::AlignedBox3d(Vector3d(-0.7, -0.1, 1.3), Vector3d(-0.2, 1.1, 1.7)),
      Eigen::AlignedBox3d(Vector3d(0.3, 0.3, 1.0), Vector3d(0.9, 1.1, 1.5)),
      Eigen::AlignedBox3d(Vector3d(0.0, -0.9, 1.6), Vector3d(0.5, -0.3, 2.0))};

  /// Grey level at a surface point: broad-band but smooth over a few pixels, so that interpolation is
  /// accurate.
  [[nodiscard]] static double brightness(const Vector3d& p) {
    double sum = 0;
    double amplitude = 34;
    double frequency = 7;
    for (int octave = 0; octave < 3; ++octave) {
      sum += amplitude * (std::sin(frequency * (p.x() + 0.3 * p.y()) + octave) +
                          std::sin(frequency * (p.y() - 0.4 * p.z()) + 2.0 * octave) +
                          std::sin(frequency * (p.z() + 0.5 * p.x()) + 3.0 * octave));
      amplitude *= 0.62;
      frequency *= 2.3;
    }
    return std::clamp(128.0 + 0.6 * sum, 0.0, 255.0);
  }

  /// Distance along a ray (not normalised) to the nearest surface.
  [[nodiscard]] double hit(const Vector3d& origin, const Vector3d& ray) const {
    double nearest = std::numeric_limits<double>::infinity();
    double enter = 0, leave = 0;
    slab(room, origin, ray, enter, leave);
    nearest = leave;
    for (const auto& box : furniture) {
      if (slab(box, origin, ray, enter, leave) && enter > 0) nearest = std::min(nearest, enter);
    }
    return nearest;
  }

  [[nodiscard]] RgbdFrame render(const PinholeCamera& camera, const SE3& T_world_camera,
                                 std::int64_t timestamp_ns) const {
    RgbdFrame frame;
    frame.timestamp_ns = timestamp_ns;
    frame.color = ColorImage(camera.width_px, camera.height_px);
    frame.depth_m = DepthImage(camera.width_px, camera.height_px);
    for (int y = 0; y < camera.height_px; ++y) {
      for (int x = 0; x < camera.width_px; ++x) {
        const Seen seen = look(camera, T_world_camera, x, y);
        frame.color(x, y) = {seen.level, seen.level, seen.level};
        frame.depth_m(x, y) = seen.depth_m;
      }
    }
    frame.grey = to_grey(frame.color);
    return frame;
  }

  /// What one pixel sees: z-depth and grey level.
  struct Seen {
    float depth_m = 0;
    std::uint8_t level = 0;
  };
  [[nodiscard]] Seen look(const PinholeCamera& camera, const SE3& T_world_camera, int x, int y) const {
    const Vector3d ray = T_world_camera.rotation * camera.back_project(x, y, 1.0);  // z = 1: t is z-depth
    const double depth_m = hit(T_world_camera.translation, ray);
    const double grey = brightness(T_world_camera.translation + depth_m * ray);
    return {static_cast<float>(depth_m), static_cast<std::uint8_t>(std::lround(grey))};
  }

 private:
  static bool slab(const Eigen::AlignedBox3d& box, const Vector3d& origin, const Vector3d& ray, double& enter,
                   double& leave) {
    const Eigen::Array3d a = (box.min() - origin).array() / ray.array();
    const Eigen::Array3d b = (box.max() - origin).array() / ray.array();
    enter = a.min(b).maxCoeff();
    leave = a.max(b).minCoeff();
    return enter < leave;
  }
};

/// A quarter-VGA camera with a 67 degree view.
inline PinholeCamera small_camera() { return {320, 240, 240.0, 240.0, 159.5, 119.5}; }

}  // namespace fusebench::testing
