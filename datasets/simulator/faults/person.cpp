#include "datasets/simulator/faults/person.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/texture/texture_patterns.hpp"

namespace fusebench::simulator::faults {

namespace {

constexpr std::uint64_t kPerson = 0xFB;  // key of an independent random stream

constexpr double kSpeed_mps = 1.0;
constexpr double kSteps_hz = 1.8;
constexpr double kRise_m = 0.02;

constexpr std::uint32_t kRings = 24;  // from pole to pole
constexpr std::uint32_t kSectors = 32;
constexpr double kTexture_m = 0.25;
constexpr float kLight = 0.6F;  // about that of the furnished room

enum Cloth : std::int32_t { kSkin, kShirt, kTrousers };

struct BodyPart {
  Vector3d middle_m;
  Vector3d half_m;
  Cloth cloth;
};
const std::array<BodyPart, 6> kParts = {{
    {{0, 0, 1.62}, {0.10, 0.08, 0.13}, kSkin},
    {{0, 0, 1.16}, {0.13, 0.21, 0.36}, kShirt},
    {{0, 0.27, 1.14}, {0.06, 0.06, 0.34}, kShirt},
    {{0, -0.27, 1.14}, {0.06, 0.06, 0.34}, kShirt},
    {{0, 0.10, 0.46}, {0.10, 0.09, 0.46}, kTrousers},
    {{0, -0.10, 0.46}, {0.10, 0.09, 0.46}, kTrousers},
}};

void add_ellipsoid(const BodyPart& part, scene::SimulatedScene& scene) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
    const double polar = std::numbers::pi * ring / kRings;
    // the vertices of the seam are duplicated for the texture
    for (std::uint32_t s = 0; s <= kSectors; ++s) {
      const double angle = 2 * std::numbers::pi * s / kSectors;
      const Vector3d unit(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                          std::cos(polar));
      const Vector3d at_m = part.middle_m + part.half_m.cwiseProduct(unit);
      scene.mesh.vertices.push_back(at_m.cast<float>());
      const double around_m = angle * 0.5 * (part.half_m.x() + part.half_m.y());
      scene.texture_coordinates.push_back((Vector2d(around_m, at_m.z()) / kTexture_m).cast<float>());
    }
  }
  const auto vertex = [&](std::uint32_t ring, std::uint32_t s) { return first + ring * (kSectors + 1) + s; };
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    for (std::uint32_t s = 0; s < kSectors; ++s) {
      // At the poles one of the two triangles has no area.
      if (ring + 1 < kRings)
        scene.mesh.triangles.push_back({vertex(ring, s), vertex(ring + 1, s), vertex(ring + 1, s + 1)});
      if (ring > 0)
        scene.mesh.triangles.push_back({vertex(ring, s), vertex(ring + 1, s + 1), vertex(ring, s + 1)});
    }
  }
  scene.triangle_textures.resize(scene.mesh.triangles.size(), part.cloth);
}

}  // namespace

scene::SimulatedScene person_surface(std::uint64_t seed) {
  const std::uint64_t key = random::mix_key(seed, kPerson);
  scene::SimulatedScene scene;
  for (const BodyPart& part : kParts) add_ellipsoid(part, scene);
  const auto paint = [&](std::uint32_t ground, std::uint32_t speckle, Cloth cloth) {
    const auto stream = random::mix_key(key, static_cast<std::uint64_t>(cloth));
    scene.textures.emplace_back(texture::paint_speckles(256, texture::reflectance_of(ground),
                                                        texture::reflectance_of(speckle), stream));
  };
  paint(0xc68e6a, 0xb07a58, kSkin);
  paint(0x2e5a8c, 0xd8dde2, kShirt);
  paint(0x3a3f47, 0x1c1f24, kTrousers);
  scene.light.assign(scene.mesh.vertices.size(), kLight);
  return scene;
}

PersonWalk::PersonWalk(const SE3& T_world_camera, double middle_s, double distance_m, double floor_m)
    : middle_s_(middle_s) {
  const Matrix3d R_world_camera = T_world_camera.rotation_matrix();
  // For a camera that looks straight up or down, forward is the direction of its upper image edge.
  const auto level = [](const Vector3d& direction) { return Vector3d(direction.x(), direction.y(), 0); };
  Vector3d forward = level(R_world_camera.col(2));
  if (forward.norm() < 0.1) forward = level(-R_world_camera.col(1));
  forward.normalize();
  along_ = forward.cross(Vector3d::UnitZ());
  middle_m_ = level(T_world_camera.translation) + distance_m * forward + floor_m * Vector3d::UnitZ();
}

SE3 PersonWalk::T_world_person(double time_s) const {
  const double after_s = time_s - middle_s_;
  const double rise_m = kRise_m * std::abs(std::sin(std::numbers::pi * kSteps_hz * after_s));
  const double heading_rad = std::atan2(along_.y(), along_.x());
  return {so3_exp({0, 0, heading_rad}),
          middle_m_ + kSpeed_mps * after_s * along_ + rise_m * Vector3d::UnitZ()};
}

}  // namespace fusebench::simulator::faults
