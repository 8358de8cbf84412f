#include "datasets/simulator/scene/room_lighting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "datasets/simulator/rays/ray_caster.hpp"

namespace fusebench::simulator::scene {

namespace {

constexpr int kAmbientRays = 32;
constexpr double kAmbientReach_m = 1.2;
constexpr double kLift_m = 0.01;  // distance from the surface that avoids self-occlusion
constexpr double kLampRadius_m = 0.12;
constexpr double kMinAmbientShare = 0.25;  // share of the ambient light in a closed corner, from reflections

/// Cosine-weighted directions over the hemisphere about z, equal for all vertices so that neighbours differ
/// smoothly.
std::array<Vector3d, kAmbientRays> hemisphere() {
  std::array<Vector3d, kAmbientRays> directions;
  for (int i = 0; i < kAmbientRays; ++i) {
    const double radius = std::sqrt((i + 0.5) / kAmbientRays);
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));  // golden angle
    directions[static_cast<std::size_t>(i)] = {radius * std::cos(angle), radius * std::sin(angle),
                                               std::sqrt(1 - radius * radius)};
  }
  return directions;
}

constexpr std::array<std::array<double, 3>, 4> kLampPoints = {
    {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}};

double lamp_light(const rays::RayCaster& caster, const Lamp& lamp, const Vector3d& point,
                  const Vector3d& normal) {
  double sum = 0;
  for (const auto& [x, y, z] : kLampPoints) {
    const Vector3d source = lamp.position + kLampRadius_m / std::sqrt(3.0) * Vector3d(x, y, z);
    const Vector3d to_source = source - point;
    const double facing = normal.dot(to_source.normalized());
    if (facing <= 0 || caster.blocked(point.cast<float>(), to_source.cast<float>())) continue;
    sum += facing * lamp.strength / to_source.squaredNorm();
  }
  return sum / static_cast<double>(kLampPoints.size());
}

}  // namespace

void bake_light(SimulatedScene& scene, const std::vector<Lamp>& lamps, double ambient) {
  const rays::RayCaster caster(scene.mesh);
  const std::array<Vector3d, kAmbientRays> directions = hemisphere();
  for (std::size_t i = 0; i < scene.mesh.vertices.size(); ++i) {
    const Vector3d normal = scene.mesh.normals[i].cast<double>();
    const Vector3d point = scene.mesh.vertices[i].cast<double>() + kLift_m * normal;
    const Matrix3x2d tangents = s2_basis(normal);
    int open = 0;
    for (const Vector3d& d : directions) {
      const Vector3d world = tangents.col(0) * d.x() + tangents.col(1) * d.y() + normal * d.z();
      if (!caster.blocked(point.cast<float>(), (kAmbientReach_m * world).cast<float>())) ++open;
    }
    const double shield = kMinAmbientShare + (1 - kMinAmbientShare) * open / kAmbientRays;
    double light = ambient * shield;
    for (const Lamp& lamp : lamps) light += lamp_light(caster, lamp, point, normal);
    scene.light[i] *= static_cast<float>(std::min(light, 1.25));
  }
}

}  // namespace fusebench::simulator::scene
