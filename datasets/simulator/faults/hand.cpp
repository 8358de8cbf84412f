#include "datasets/simulator/faults/hand.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/texture/texture_patterns.hpp"

namespace fusebench::simulator::faults {

namespace {

constexpr std::uint64_t kHand = 0xFA;  // key of an independent random stream

constexpr double kDistance_m = 0.4;
constexpr double kDome_m = 0.03;
constexpr double kMaxReach_m = 0.1;
constexpr double kMaxTurn_rad = 0.15;
// Ratio of the area of |x|^4 + |y|^4 <= 1 to that of its bounding square: Gamma(5/4)^2 / Gamma(3/2).
constexpr double kAreaOfSquare = 0.92703733865;
const Vector3d kFrequencies_hz(0.9, 0.6, 0.5);  // sideways, vertical, rotation

constexpr std::uint32_t kRings = 12;
constexpr std::uint32_t kSectors = 64;
constexpr double kTexture_m = 0.12;
constexpr float kLight = 0.6F;  // about that of the furnished room

double root_with_sign(double x) { return std::copysign(std::sqrt(std::abs(x)), x); }

}  // namespace

Hand::Hand(const PinholeCamera& color, double share, std::uint64_t seed)
    : seed_(random::mix_key(seed, kHand)) {
  const double scale = std::sqrt(share / kAreaOfSquare);
  const Vector2d image_m(kDistance_m * color.width_px / color.fx_px,
                         kDistance_m * color.height_px / color.fy_px);
  half_m_ = 0.5 * scale * image_m;
  middle_m_ =
      color.back_project(0.5 * (color.width_px - 1), 0.5 * (color.height_px - 1), kDistance_m).head<2>();
  const double free = std::max(0.0, 1 - scale);
  turn_rad_ = kMaxTurn_rad * free;
  // The rotation of the card takes a part of the free margin.
  const Vector2d corner_m = turn_rad_ * half_m_.reverse();
  reach_m_ = (0.5 * free * image_m - corner_m).cwiseMax(0.0).cwiseMin(kMaxReach_m);
  random::RandomSequence random(seed_);
  for (double& phase : phase_rad_) phase = random.uniform(0, 2 * std::numbers::pi);
}

scene::SimulatedScene Hand::surface() const {
  scene::SimulatedScene scene;
  const auto add = [&](double radius, double angle) {
    const double x = radius * half_m_.x() * root_with_sign(std::cos(angle));
    const double y = radius * half_m_.y() * root_with_sign(std::sin(angle));
    scene.mesh.vertices.push_back(Vector3d(x, y, -kDome_m * (1 - radius * radius)).cast<float>());
    scene.texture_coordinates.push_back((Vector2d(x, y) / kTexture_m).cast<float>());
  };
  add(0, 0);
  for (std::uint32_t ring = 1; ring <= kRings; ++ring) {
    for (std::uint32_t s = 0; s < kSectors; ++s) {
      add(static_cast<double>(ring) / kRings, 2 * std::numbers::pi * s / kSectors);
    }
  }
  const auto vertex = [](std::uint32_t ring, std::uint32_t s) {
    return ring == 0 ? 0 : 1 + (ring - 1) * kSectors + s % kSectors;
  };
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    for (std::uint32_t s = 0; s < kSectors; ++s) {
      scene.mesh.triangles.push_back({vertex(ring, s), vertex(ring + 1, s + 1), vertex(ring + 1, s)});
      if (ring == 0) continue;
      scene.mesh.triangles.push_back({vertex(ring, s), vertex(ring, s + 1), vertex(ring + 1, s + 1)});
    }
  }
  scene.textures.emplace_back(texture::paint_speckles(256, texture::reflectance_of(0xc68e6a),
                                                      texture::reflectance_of(0x4a2c1d), seed_));
  scene.triangle_textures.assign(scene.mesh.triangles.size(), 0);
  scene.light.assign(scene.mesh.vertices.size(), kLight);
  return scene;
}

SE3 Hand::T_color_hand(double time_s) const {
  const Vector3d swing =
      (2 * std::numbers::pi * time_s * kFrequencies_hz + phase_rad_).array().sin().matrix();
  const Vector2d place_m = middle_m_ + reach_m_.cwiseProduct(swing.head<2>());
  return {so3_exp({0, 0, turn_rad_ * swing.z()}), {place_m.x(), place_m.y(), kDistance_m}};
}

}  // namespace fusebench::simulator::faults
