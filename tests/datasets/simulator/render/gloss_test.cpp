// Surfaces whose light depends on where they are seen from, and screens.
#include <gtest/gtest.h>

#include "datasets/simulator/render/renderer.hpp"
#include "tests/datasets/simulator/simple_scenes.hpp"

namespace fusebench {

using namespace simulator::scene;
using namespace simulator::render;

namespace {

/// The plane z = 2 m with uniform grey textures and a lamp next to the camera.
SimulatedScene glossy_plane(float gloss) {
  SimulatedScene scene = testing::plane_at(2, 0);
  for (const float grey : {0.2F, 0.5F, 0.8F}) {
    Image<Eigen::Vector3f> image(1, 1, Eigen::Vector3f::Constant(grey));
    scene.textures.emplace_back(image);
  }
  scene.triangle_textures.assign(scene.mesh.triangles.size(), 0);
  scene.texture_coordinates.assign(scene.mesh.vertices.size(), Eigen::Vector2f::Zero());
  scene.gloss = {gloss, gloss, gloss};
  scene.highlights = {{{1, 0, 0}, 0.5F}};
  return scene;
}

constexpr float kRounding = 0.0005F;  // textures have eleven significant bits

/// Light of the ray straight ahead of a camera at x.
float light_ahead(const SimulatedScene& scene, double x_m, double time_s = 0) {
  const PinholeCamera camera{32, 24, 30, 30, 15.5, 11.5};
  const simulator::rays::RayField rays(camera);
  std::vector<Eigen::Array4f> light(32, Eigen::Array4f::Zero());
  const RowSample sample{
      .row = 12, .T_world_camera = {Quaterniond::Identity(), {x_m, 0, 0}}, .time_s = time_s};
  Renderer(scene).add_light_of_row(rays, {&sample, 1}, light);
  return light[16].x();
}

TEST(Gloss, AHighlightIsSeenWhereTheLampIsMirroredAndNowhereElse) {
  const SimulatedScene glossy = glossy_plane(1);
  // The camera sees the lamp at (1, 0, 0) in a plane ahead of it when it is at the lamp's place.
  EXPECT_GT(light_ahead(glossy, 1), 0.6F);
  EXPECT_NEAR(light_ahead(glossy, -1), 0.2F, 0.04F);
  const SimulatedScene matt = glossy_plane(0);
  EXPECT_FLOAT_EQ(light_ahead(matt, 1), light_ahead(matt, -1));
  EXPECT_NEAR(light_ahead(matt, 1), 0.2F, kRounding);
}

TEST(Gloss, ScreensChangeTheirPagesInTime) {
  SimulatedScene scene = glossy_plane(0);
  EXPECT_NEAR(light_ahead(scene, 0, kPage_s * 1.5), 0.2F, kRounding);
  scene.screens = {0, 3};
  EXPECT_NEAR(light_ahead(scene, 0, kPage_s * 0.5), 0.2F, kRounding);
  EXPECT_NEAR(light_ahead(scene, 0, kPage_s * 1.5), 0.5F, kRounding);
  EXPECT_NEAR(light_ahead(scene, 0, kPage_s * 2.5), 0.8F, kRounding);
  EXPECT_NEAR(light_ahead(scene, 0, kPage_s * 3.5), 0.2F, kRounding);
}

}  // namespace
}  // namespace fusebench
