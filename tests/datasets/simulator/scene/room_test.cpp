#include "datasets/simulator/scene/room.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/rays/ray_caster.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "tests/datasets/simulator/simple_scenes.hpp"

namespace fusebench {

using namespace simulator::random;
using namespace simulator::rays;
using namespace simulator::scene;
using namespace simulator::render;
using namespace simulator::sensors;

namespace {

const SimulatedScene& room_of_seed(std::uint64_t seed) {
  static std::map<std::uint64_t, SimulatedScene> rooms;
  auto found = rooms.find(seed);
  if (found == rooms.end()) found = rooms.emplace(seed, make_room(seed)).first;
  return found->second;
}

/// A direction, evenly over the sphere.
Eigen::Vector3f direction(std::uint64_t i) {
  const double z = 2 * unit_interval(mix_bits(2 * i)) - 1;
  const double angle = 2 * std::numbers::pi * unit_interval(mix_bits(2 * i + 1));
  const double r = std::sqrt(1 - z * z);
  return Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
}

TEST(Room, IsAFunctionOfTheSeed) {
  const SimulatedScene again = make_room(1);
  EXPECT_EQ(again.mesh.vertices, room_of_seed(1).mesh.vertices);
  EXPECT_EQ(again.mesh.colors, room_of_seed(1).mesh.colors);
  EXPECT_EQ(again.light, room_of_seed(1).light);
  EXPECT_EQ(again.texture_coordinates, room_of_seed(1).texture_coordinates);
  EXPECT_NE(again.mesh.vertices, room_of_seed(2).mesh.vertices);
}

TEST(Room, HasSoundTriangles) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SimulatedScene& room = room_of_seed(seed);
    const std::size_t vertices = room.mesh.vertices.size();
    EXPECT_GT(room.mesh.triangles.size(), 20000U);
    EXPECT_LT(room.mesh.triangles.size(), 100000U);
    EXPECT_EQ(room.mesh.normals.size(), vertices);
    EXPECT_EQ(room.mesh.colors.size(), vertices);
    EXPECT_EQ(room.light.size(), vertices);
    EXPECT_EQ(room.texture_coordinates.size(), vertices);
    EXPECT_EQ(room.triangle_textures.size(), room.mesh.triangles.size());
    for (const auto& t : room.mesh.triangles) {
      const Eigen::Vector3f a = room.mesh.vertices[t[0]];
      const Eigen::Vector3f area = (room.mesh.vertices[t[1]] - a).cross(room.mesh.vertices[t[2]] - a);
      ASSERT_GT(area.norm(), 1e-8F);
      ASSERT_GT(area.normalized().dot(room.mesh.normals[t[0]]), 0.5F);  // counter-clockwise from outside
    }
    for (const float light : room.light) {
      ASSERT_GE(light, 0.0F);
      ASSERT_LT(light, 3.0F);
    }
  }
}

TEST(Room, IsClosedAndItsFreeSpaceIsFree) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SimulatedScene& room = room_of_seed(seed);
    const RayCaster caster(room.mesh);
    EXPECT_GT(room.free_space.sizes().minCoeff(), 0.9);
    // From every point of a grid in the free space, all directions meet something, and that outside of it.
    for (int i = 0; i < 125; ++i) {
      const Vector3d share(i % 5, i / 5 % 5, i / 25);
      const Vector3d origin = room.free_space.min() + (share / 4).cwiseProduct(room.free_space.sizes());
      std::array<float, 400> x{}, y{}, z{};
      for (std::size_t k = 0; k < x.size(); ++k) {
        const Eigen::Vector3f d = direction(k);
        x[k] = d.x(), y[k] = d.y(), z[k] = d.z();
      }
      std::array<RayHit, 400> hits;
      caster.cast(origin.cast<float>(), x, y, z, hits);
      for (std::size_t k = 0; k < hits.size(); ++k) {
        ASSERT_NE(hits[k].triangle, RayHit::kNothing) << "seed " << seed;
        const Vector3d point = origin + static_cast<double>(hits[k].distance) * Vector3d(x[k], y[k], z[k]);
        ASSERT_GT(room.free_space.exteriorDistance(point), 0.0)
            << "seed " << seed << ": " << point.transpose();
        ASSERT_LT(point.norm(), 5.0);
      }
    }
  }
}

/// A camera in the middle of the free space that looks level (or down by tilt_rad) in the direction of an
/// angle.
SE3 view(const SimulatedScene& room, double angle_rad, double tilt_rad) {
  const Vector3d forward(std::cos(angle_rad) * std::cos(tilt_rad), std::sin(angle_rad) * std::cos(tilt_rad),
                         -std::sin(tilt_rad));
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Matrix3d rotation;
  rotation << right, forward.cross(right), forward;
  return {Quaterniond(rotation), room.free_space.center()};
}

TEST(Room, HasCornersInMostViewsAndAPlainPart) {
  ColorSensor sensor;
  sensor.camera.pinhole = {640, 480, 525.0, 525.0, 319.5, 239.5};
  sensor.blur_samples = 4;
  const simulator::rays::RayField rays(sensor.camera, Workers(1));
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SimulatedScene& room = room_of_seed(seed);
    const Renderer renderer(room);
    std::vector<double> textured;  // share of 20 px cells that hold a gradient, by view
    for (int i = 0; i < 16; ++i) {
      const SE3 pose = view(room, i * std::numbers::pi / 8, i % 2 == 0 ? 0.1 : 0.5);
      const GreyImage grey =
          to_grey(expose_color(renderer, sensor, rays, testing::straight_motion(Vector3d::Zero()), pose,
                               testing::kHalfSecond_ns, 1, 0, Workers(2)));
      int cells = 0;
      for (int y = 0; y + 20 < grey.height; y += 20) {
        for (int x = 0; x + 20 < grey.width; x += 20) {
          int strongest = 0;
          for (int v = y; v < y + 20; ++v) {
            for (int u = x; u < x + 20; ++u) {
              strongest = std::max(
                  strongest, std::abs(grey(u + 1, v) - grey(u, v)) + std::abs(grey(u, v + 1) - grey(u, v)));
            }
          }
          if (strongest > 14) ++cells;
        }
      }
      textured.push_back(cells / (23.0 * 31.0));
    }
    std::ranges::sort(textured);
    EXPECT_GT(textured[3], 0.5) << "seed " << seed;   // three quarters of the views are textured
    EXPECT_GT(textured[0], 0.03) << "seed " << seed;  // none is without anything
    EXPECT_LT(textured[0], 0.8) << "seed " << seed;   // one shows the plain part
  }
}

}  // namespace
}  // namespace fusebench
