// A preset's route in its scene, for tests of what it meets and sees.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "datasets/simulator/motion/motion.hpp"
#include "datasets/simulator/rays/ray_caster.hpp"
#include "datasets/simulator/render/renderer.hpp"
#include "datasets/simulator/room_kind.hpp"
#include "datasets/simulator/routes/route_motion.hpp"

namespace fusebench::testing {

/// The camera of TUM's freiburg1 at a tenth of its size.
inline constexpr PinholeCamera kRouteCamera = {64, 48, 51.7, 51.6, 31.4, 25.0};

/// Poses of the camera. Times are seconds from the first frame of a recording of the default duration.
class RoutePath {
 public:
  RoutePath(simulator::motion::MotionPreset preset, std::uint64_t seed, const Eigen::AlignedBox3d& free_space)
      : duration_s_(simulator::motion::usual_duration_s(preset)),
        camera_(simulator::routes::route_motion(preset, simulator::motion::motion_preset(preset),
                                                {0, kFirst_ns, kFirst_ns + std::llround(1e9 * duration_s_)},
                                                free_space, seed)) {}

  /// In a free space like those of the rooms, whichever it is in.
  RoutePath(simulator::motion::MotionPreset preset, std::uint64_t seed)
      : RoutePath(preset, seed, {Vector3d(-1.2, -1.1, 0.9), Vector3d(1.2, 1.1, 1.9)}) {}

  [[nodiscard]] const synthetic_imu::PoseSpline& camera() const { return camera_; }
  [[nodiscard]] double duration_s() const { return duration_s_; }

  [[nodiscard]] SE3 pose(double time_s) const {
    return camera_.evaluate(kFirst_ns + std::llround(1e9 * time_s)).T_world_body;
  }
  [[nodiscard]] simulator::motion::PeakSpeeds peaks(double begin_s, double end_s) const {
    return simulator::motion::peak_speeds(camera_, SE3{}, kFirst_ns + std::llround(1e9 * begin_s),
                                          kFirst_ns + std::llround(1e9 * end_s));
  }
  /// End of the route: from then on the camera is at rest except for the hand's sway.
  [[nodiscard]] double end_s() const {
    constexpr double kStep_s = 0.1;
    double end_s = duration_s_;
    while (end_s > 0) {
      const simulator::motion::PeakSpeeds speeds = peaks(end_s - kStep_s, end_s);
      if (speeds.speed_mps > 0.25 || speeds.rate_radps > 0.4) break;
      end_s -= kStep_s;
    }
    return end_s;
  }

 private:
  static constexpr std::int64_t kFirst_ns = 750'000'000;

  double duration_s_;
  synthetic_imu::PoseSpline camera_;
};

/// Collisions and views in the preset's scene, which takes seconds to build.
class RouteView {
 public:
  RouteView(simulator::motion::MotionPreset preset, std::uint64_t seed)
      : scene_(simulator::make_room_of_kind(simulator::room_of(preset), seed)),
        path_(preset, seed, scene_.free_space),
        renderer_(scene_),
        caster_(scene_.mesh) {}

  [[nodiscard]] const RoutePath& path() const { return path_; }
  [[nodiscard]] const Eigen::AlignedBox3d& free_space() const { return scene_.free_space; }
  [[nodiscard]] const simulator::render::Renderer& renderer() const { return renderer_; }

  /// Distance to the nearest surface, by rays in all directions.
  [[nodiscard]] double clearance_m(const Vector3d& place) const {
    constexpr std::size_t kRays = 600;
    std::array<float, kRays> x{};
    std::array<float, kRays> y{};
    std::array<float, kRays> z{};
    for (std::size_t i = 0; i < kRays; ++i) {  // evenly over the sphere, in a spiral
      const double height = 1 - (2.0 * static_cast<double>(i) + 1) / kRays;
      const double angle = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
      const double radius = std::sqrt(1 - height * height);
      x[i] = static_cast<float>(radius * std::cos(angle));
      y[i] = static_cast<float>(radius * std::sin(angle));
      z[i] = static_cast<float>(height);
    }
    std::array<simulator::rays::RayHit, kRays> hits;
    caster_.cast(place.cast<float>(), x, y, z, hits);
    float least = 1e6F;
    for (const auto& hit : hits) {
      if (hit.triangle != simulator::rays::RayHit::kNothing) least = std::min(least, hit.distance);
    }
    return static_cast<double>(least);
  }

  /// Share of the pixels of a view whose z-depth is between the two.
  [[nodiscard]] double share_within(const SE3& T_world_camera, float least_m, float most_m) const {
    Image<simulator::render::Renderer::Surface> surfaces;
    renderer_.render_surfaces(kRouteCamera, {{T_world_camera}}, Workers(1), surfaces);
    int within = 0;
    for (const auto& surface : surfaces.data) {
      if (surface.depth_m >= least_m && surface.depth_m <= most_m) ++within;
    }
    return static_cast<double>(within) / static_cast<double>(surfaces.data.size());
  }

 private:
  simulator::scene::SimulatedScene scene_;
  RoutePath path_;
  simulator::render::Renderer renderer_;
  simulator::rays::RayCaster caster_;
};

}  // namespace fusebench::testing
