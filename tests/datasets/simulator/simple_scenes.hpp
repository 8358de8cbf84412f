// Scenes in closed form, and motions at constant speed, for tests of the simulator.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "datasets/simulator/scene/scene.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"

namespace fusebench::testing {

inline constexpr std::uint8_t kWhite = 255;
inline constexpr std::int64_t kHalfSecond_ns = 500'000'000;  ///< the middle of straight_motion()

/// Adds a rectangle of one colour: corner, corner + along, corner + along + up, corner + up.
inline void add_rectangle(simulator::scene::SimulatedScene& scene, const Eigen::Vector3f& corner,
                          const Eigen::Vector3f& along, const Eigen::Vector3f& up, std::uint8_t grey) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  for (const Eigen::Vector3f& point : {corner, Eigen::Vector3f(corner + along),
                                       Eigen::Vector3f(corner + along + up), Eigen::Vector3f(corner + up)}) {
    scene.mesh.vertices.push_back(point);
    scene.mesh.colors.push_back({grey, grey, grey});
  }
  scene.mesh.triangles.push_back({first, first + 1, first + 2});
  scene.mesh.triangles.push_back({first, first + 2, first + 3});
}

/// The plane z = depth, one colour.
inline simulator::scene::SimulatedScene plane_at(float depth_m, std::uint8_t grey) {
  simulator::scene::SimulatedScene scene;
  add_rectangle(scene, {-20, -20, depth_m}, {40, 0, 0}, {0, 40, 0}, grey);
  return scene;
}

/// The plane z = depth, black where x < 0 and white elsewhere.
inline simulator::scene::SimulatedScene edge_at(float depth_m) {
  simulator::scene::SimulatedScene scene;
  add_rectangle(scene, {-20, -20, depth_m}, {20, 0, 0}, {0, 40, 0}, 0);
  add_rectangle(scene, {0, -20, depth_m}, {20, 0, 0}, {0, 40, 0}, kWhite);
  return scene;
}

/// A sphere of quads in rings.
inline simulator::scene::SimulatedScene sphere_at(const Eigen::Vector3f& centre, float radius_m, int rings) {
  simulator::scene::SimulatedScene scene;
  const auto point = [&](int i, int j) -> Eigen::Vector3f {
    const float polar = std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(rings);
    const float angle = std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(rings);
    return centre + radius_m * Eigen::Vector3f(std::sin(polar) * std::cos(angle),
                                               std::sin(polar) * std::sin(angle), std::cos(polar));
  };
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < 2 * rings; ++i) {
      const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
      for (const auto& [x, y] :
           {std::array{i, j}, std::array{i + 1, j}, std::array{i + 1, j + 1}, std::array{i, j + 1}}) {
        scene.mesh.vertices.push_back(point(x, y));
        scene.mesh.colors.push_back({128, 128, 128});
      }
      scene.mesh.triangles.push_back({first, first + 1, first + 2});
      scene.mesh.triangles.push_back({first, first + 2, first + 3});
    }
  }
  return scene;
}

/// Constant velocity from t = 0 to 1 s, at the origin of the world at 0.5 s, with the world's axes.
inline synthetic_imu::PoseSpline straight_motion(const Vector3d& velocity_mps) {
  synthetic_imu::PoseSpline spline(0, 1'000'000'000, 100'000'000);
  for (std::size_t i = 0; i < spline.position_world_m.size(); ++i) {
    spline.position_world_m[i] = seconds_between(kHalfSecond_ns, spline.control_time_ns(i)) * velocity_mps;
  }
  return spline;
}

inline PinholeCamera test_camera() { return {160, 120, 150.0, 150.0, 79.5, 59.5}; }

}  // namespace fusebench::testing
