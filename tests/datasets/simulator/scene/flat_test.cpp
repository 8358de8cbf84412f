// Scenes of several rooms, and long ones.
#include "datasets/simulator/scene/flat.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/simulator/motion/motion_heading.hpp"
#include "datasets/simulator/render/renderer.hpp"
#include "datasets/simulator/scene/corridor.hpp"
#include "datasets/simulator/scene/gallery.hpp"
#include "datasets/simulator/scene/scene_parts.hpp"
#include "datasets/simulator/texture/texture_patterns.hpp"

namespace fusebench {

using namespace simulator::scene;
using simulator::motion::looking;
using simulator::render::Renderer;

namespace {

constexpr PinholeCamera kCamera = {96, 72, 78, 78, 47.5, 35.5};

/// Level views to all sides from a place of the first room. On the grid of parts, so that it can be shifted
/// exactly.
SE3 view_of_first_room(int i) {
  const Vector3d place(0.25 * (i % 5 - 2), FlatShape::kRoomMiddle_m + 0.25 * (i % 3 - 1), 1.375);
  return {looking(radians(40.0 * i), -0.2, 0), place};
}

SE3 shifted(const SE3& pose, double x_m) { return {pose.rotation, pose.translation + Vector3d(x_m, 0, 0)}; }

struct View {
  Image<Renderer::Surface> surfaces;
  Image<Eigen::Vector3f> light;
};

View look(const Renderer& renderer, const SE3& T_world_camera) {
  View view;
  renderer.render_surfaces(kCamera, {{T_world_camera}}, Workers(1), view.surfaces);
  renderer.render_light(kCamera, {{T_world_camera}}, Vector2d::Zero(), Workers(1), view.light);
  return view;
}

/// Share of the pixels whose depth or light differs.
double share_different(const View& a, const View& b) {
  int different = 0;
  for (std::size_t i = 0; i < a.light.data.size(); ++i) {
    const float depth_m = std::abs(a.surfaces.data[i].depth_m - b.surfaces.data[i].depth_m);
    const float light = (a.light.data[i] - b.light.data[i]).cwiseAbs().maxCoeff();
    if (depth_m > 1e-4F || light > 2e-3F) ++different;
  }
  return static_cast<double>(different) / static_cast<double>(a.light.data.size());
}

void expect_sound(const SimulatedScene& scene) {
  const std::size_t vertices = scene.mesh.vertices.size();
  EXPECT_EQ(scene.mesh.normals.size(), vertices);
  EXPECT_EQ(scene.mesh.colors.size(), vertices);
  EXPECT_EQ(scene.light.size(), vertices);
  EXPECT_EQ(scene.texture_coordinates.size(), vertices);
  ASSERT_EQ(scene.triangle_textures.size(), scene.mesh.triangles.size());
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    ASSERT_LT(static_cast<std::size_t>(scene.triangle_textures[i]), scene.textures.size());
    const auto& t = scene.mesh.triangles[i];
    const Vector3d a = scene.mesh.vertices[t[0]].cast<double>();
    const Vector3d area =
        (scene.mesh.vertices[t[1]].cast<double>() - a).cross(scene.mesh.vertices[t[2]].cast<double>() - a);
    ASSERT_GT(area.norm(), 1e-10);
    ASSERT_GT(area.normalized().dot(scene.mesh.normals[t[0]].cast<double>()), 0.3);  // seen from outside
  }
}

TEST(TwinRoomsScene, BothRoomsAreEqual) {
  const SimulatedScene scene = make_twin_rooms(3);
  expect_sound(scene);
  const Renderer renderer(scene);
  for (int i = 0; i < 18; ++i) {
    const SE3 first = view_of_first_room(i);
    const View one = look(renderer, first);
    const View other = look(renderer, shifted(first, FlatShape::kUnit_m));
    // Rays through the door may reach the ends of the corridor; edges may fall to either of two pixels.
    EXPECT_LT(share_different(one, other), 0.002) << i;
  }
}

TEST(TwinRoomsScene, VerticesOfBothRoomsAgreeToTheBit) {
  const Mesh mesh = make_twin_rooms(1).mesh;
  std::vector<Eigen::Vector3f> second;
  std::size_t first_room = 0;
  const auto middle = static_cast<float>(0.5 * FlatShape::kUnit_m);
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    if (vertex.y() < 0.3F) continue;  // the door's frame and the corridor
    if (vertex.x() < middle) {
      ++first_room;
      second.emplace_back(vertex + Eigen::Vector3f(static_cast<float>(FlatShape::kUnit_m), 0, 0));
    }
  }
  std::size_t found = 0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {  // in the same order
    if (vertex.y() < 0.3F || vertex.x() < middle) continue;
    ASSERT_LT(found, second.size());
    ASSERT_EQ(vertex, second[found++]);
  }
  EXPECT_EQ(found, first_room);
  EXPECT_GT(found, 10000U);
}

TEST(FlatScene, RoomsDiffer) {
  const SimulatedScene scene = make_flat(1);
  expect_sound(scene);
  const Renderer renderer(scene);
  for (int i = 0; i < 18; i += 3) {
    const SE3 first = view_of_first_room(i);
    const View one = look(renderer, first);
    for (int room = 1; room < kFlatRooms; ++room)
      EXPECT_GT(share_different(one, look(renderer, shifted(first, room * FlatShape::kUnit_m))), 0.5) << i;
  }
}

TEST(LongScene, IsAFunctionOfTheSeed) {
  for (const auto make : {make_corridor, make_gallery}) {
    const SimulatedScene scene = make(1);
    expect_sound(scene);
    const SimulatedScene again = make(1);
    EXPECT_EQ(again.mesh.vertices, scene.mesh.vertices);
    EXPECT_EQ(again.mesh.colors, scene.mesh.colors);
    EXPECT_EQ(again.light, scene.light);
    EXPECT_NE(make(2).mesh.vertices, scene.mesh.vertices);
  }
}

TEST(SceneParts, CopiesShareTexturesAndKeepTheirShape) {
  SimulatedScene part;
  part.mesh.vertices = {{0.1F, 0.2F, 0.3F}, {1.1F, 0.2F, 0.3F}, {0.1F, 1.2F, 0.3F}};
  part.mesh.normals.assign(3, Eigen::Vector3f::UnitZ());
  part.mesh.triangles = {{0, 1, 2}};
  part.texture_coordinates.assign(3, {0, 0});
  part.light.assign(3, 0.5F);
  part.triangle_textures = {0};
  part.textures.emplace_back(simulator::texture::paint_plain({0.5F, 0.5F, 0.5F}));
  SimulatedScene scene;
  EXPECT_EQ(add_part_textures(scene, part), 0);
  EXPECT_EQ(add_part_textures(scene, part), 1);
  add_part(scene, part, 1, {0, 0, 0});
  add_part(scene, part, 1, {64.25, 0, 0});
  EXPECT_EQ(scene.textures.size(), 2U);
  EXPECT_EQ(scene.triangle_textures, (std::vector<std::int32_t>{1, 1}));
  EXPECT_EQ(scene.mesh.triangles[1][2], 5U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(scene.mesh.vertices[i].x(), part.mesh.vertices[i].x(), kPartGrid_m);
    EXPECT_EQ(scene.mesh.vertices[i + 3].x() - scene.mesh.vertices[i].x(), 64.25F);  // exactly
  }
}

}  // namespace
}  // namespace fusebench
