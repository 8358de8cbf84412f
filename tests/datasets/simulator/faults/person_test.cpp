#include "datasets/simulator/faults/person.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace fusebench {

using namespace simulator;
using namespace simulator::faults;

namespace {

TEST(SimulatedPerson, IsClosedStandsOnTheFloorAndIsAsTallAsAPerson) {
  const scene::SimulatedScene person = person_surface(1);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : person.mesh.vertices) box.extend(vertex);
  EXPECT_NEAR(box.min().z(), 0, 1e-6);
  EXPECT_NEAR(box.max().z(), 1.75, 1e-6);
  EXPECT_LT(box.sizes().y(), 0.8);
  // Divergence theorem: triangles that face outwards enclose a positive volume, that of the six ellipsoids.
  double volume_m3 = 0;
  for (const auto& triangle : person.mesh.triangles) {
    const Vector3d a = person.mesh.vertices[triangle[0]].cast<double>();
    const Vector3d b = person.mesh.vertices[triangle[1]].cast<double>();
    const Vector3d c = person.mesh.vertices[triangle[2]].cast<double>();
    volume_m3 += a.dot(b.cross(c)) / 6;
  }
  const double ellipsoids_m3 =
      4.0 / 3 * std::numbers::pi *
      (0.10 * 0.08 * 0.13 + 0.13 * 0.21 * 0.36 + 2 * 0.06 * 0.06 * 0.34 + 2 * 0.10 * 0.09 * 0.46);
  EXPECT_NEAR(volume_m3, ellipsoids_m3, 0.03 * ellipsoids_m3);
  EXPECT_EQ(person.triangle_textures.size(), person.mesh.triangles.size());
  EXPECT_LT(*std::ranges::max_element(person.triangle_textures),
            static_cast<std::int32_t>(person.textures.size()));
}

TEST(SimulatedPerson, CrossesTheViewHalfwayAtItsSpeed) {
  // x of the camera to the right, y down, z along x of the world, pitched 30 degrees down.
  const Matrix3d level = (Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished();
  const SE3 T_world_camera{Quaterniond(level) * so3_exp({-0.52, 0, 0}), {1, 2, 1.4}};
  const PersonWalk walk(T_world_camera, 3, 1.5, -0.2);
  const SE3 halfway = walk.T_world_person(3);
  EXPECT_LT((halfway.translation - Vector3d(2.5, 2, -0.2)).norm(), 1e-9);
  const Vector3d travelled = walk.T_world_person(4).translation - walk.T_world_person(2).translation;
  EXPECT_NEAR(travelled.head<2>().norm(), 2, 1e-9);
  EXPECT_NEAR((T_world_camera.rotation.conjugate() * travelled).z(), 0, 0.05) << "steps rise by 2 cm";
  const Vector3d facing = halfway.rotation * Vector3d::UnitX();
  EXPECT_LT((facing - travelled.normalized()).norm(), 0.02);
  for (const double time_s : {1.0, 2.3, 3.6}) {
    const double rise_m = walk.T_world_person(time_s).translation.z() + 0.2;
    EXPECT_GE(rise_m, -1e-12);
    EXPECT_LE(rise_m, 0.02 + 1e-12);
  }
}

TEST(SimulatedPerson, PassesACameraThatLooksStraightDown) {
  const SE3 T_world_camera{so3_exp({std::numbers::pi, 0, 0}), {0, 0, 2}};
  const SE3 halfway = PersonWalk(T_world_camera, 0, 1, 0).T_world_person(0);
  EXPECT_NEAR(halfway.translation.norm(), 1, 1e-9);
  EXPECT_NEAR(halfway.translation.z(), 0, 1e-12);
}

}  // namespace
}  // namespace fusebench
