#include "datasets/simulator/render/renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/texture/texture_patterns.hpp"
#include "tests/datasets/simulator/simple_scenes.hpp"

namespace fusebench {

using namespace simulator::random;
using namespace simulator::texture;
using namespace simulator::scene;
using namespace simulator::render;

namespace {

using testing::add_rectangle;
using testing::plane_at;
using testing::test_camera;

const RowPoses kAtOrigin{{SE3{}}};

TEST(Renderer, DepthOfATiltedPlaneIsExact) {
  // The plane through (0, 0, 2) with normal (0.3, -0.2, -1).
  const Vector3d normal(0.3, -0.2, -1);
  SimulatedScene scene;
  const auto on_plane = [&](double x, double y) -> Eigen::Vector3f {
    return Vector3d(x, y, 2 + normal.x() * x + normal.y() * y).cast<float>();
  };
  add_rectangle(scene, on_plane(-5, -5), on_plane(5, -5) - on_plane(-5, -5),
                on_plane(-5, 5) - on_plane(-5, -5), 90);
  const PinholeCamera camera = test_camera();
  Image<Renderer::Surface> surfaces;
  Renderer(scene).render_surfaces(camera, kAtOrigin, Workers(1), surfaces);
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Vector3d ray = camera.back_project(u, v, 1);
      const double expected = 2 * normal.z() / normal.dot(ray);
      ASSERT_NEAR(surfaces(u, v).depth_m, expected, 1e-5) << u << ' ' << v;
      ASSERT_NEAR(surfaces(u, v).cos_incidence, -normal.normalized().dot(ray.normalized()), 1e-5);
    }
  }
}

TEST(Renderer, DepthOfASphereFromAMovedAndTurnedCamera) {
  const Vector3d centre(0.4, -0.3, 2.5);
  const double radius = 0.7;
  const Renderer renderer(testing::sphere_at(centre.cast<float>(), static_cast<float>(radius), 400));
  const SE3 pose{so3_exp({0.1, -0.15, 0.4}), {0.2, 0.1, -0.3}};
  const PinholeCamera camera = test_camera();
  Image<Renderer::Surface> surfaces;
  renderer.render_surfaces(camera, {{pose}}, Workers(1), surfaces);
  const Vector3d centre_camera = pose.inverse() * centre;
  int inside = 0;
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Vector3d ray = camera.back_project(u, v, 1);
      const double b = ray.dot(centre_camera);
      const double root = b * b - ray.squaredNorm() * (centre_camera.squaredNorm() - radius * radius);
      if (root < -0.05) {
        ASSERT_EQ(surfaces(u, v).depth_m, 0) << u << ' ' << v;
      }
      if (root < 0.3) continue;  // the facets of the rim
      ++inside;
      ASSERT_NEAR(surfaces(u, v).depth_m, (b - std::sqrt(root)) / ray.squaredNorm(), 1e-4);
    }
  }
  EXPECT_GT(inside, 1000);
}

TEST(Renderer, ShowsColoursInLinearLightAndNothingAsBlack) {
  SimulatedScene scene;
  add_rectangle(scene, {0, -20, 2}, {20, 0, 0}, {0, 40, 0}, 188);
  Image<Eigen::Vector3f> light;
  Renderer(scene).render_light(test_camera(), kAtOrigin, Vector2d::Zero(), Workers(1), light);
  EXPECT_EQ(light(10, 60), Eigen::Vector3f::Zero().eval());
  EXPECT_NEAR(light(150, 60).x(), linear_from_srgb(188 / 255.0), 1e-5);
}

/// The plane z = 1 with a texture of this image: u = x / repeat, v = y / repeat.
SimulatedScene textured_plane(const ReflectanceImage& image, float repeat_m, float light) {
  SimulatedScene scene = plane_at(1, 0);
  scene.textures.emplace_back(image);
  scene.triangle_textures.assign(scene.mesh.triangles.size(), 0);
  for (const Eigen::Vector3f& vertex : scene.mesh.vertices) {
    scene.texture_coordinates.emplace_back(vertex.head<2>() / repeat_m);
    scene.light.push_back(light);
  }
  return scene;
}

TEST(Renderer, ShowsTheTextureTimesTheLight) {
  // Texels as large as pixels at 1 m: then a texel's centre shows the texel.
  constexpr int kSide = 64;
  ReflectanceImage image(kSide, kSide, Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = Eigen::Vector3f::Constant(static_cast<float>(unit_interval(mix_bits(i))));
  }
  const PinholeCamera camera{64, 64, 64.0, 64.0, 31.5, 31.5};
  Image<Eigen::Vector3f> light;
  Renderer(textured_plane(image, 1.0F, 0.5F))
      .render_light(camera, kAtOrigin, Vector2d::Zero(), Workers(1), light);
  // The pixel in the middle looks straight ahead; obliquely seen ones are averaged over a little more than a
  // texel.
  const auto texel = [&](int u, int v) { return image((u + 32) % kSide, (v + 32) % kSide).y(); };
  for (const auto& [u, v] :
       {std::array{31, 31}, std::array{32, 31}, std::array{31, 32}, std::array{32, 32}}) {
    EXPECT_NEAR(light(u, v).y(), 0.5F * texel(u, v), 1e-3) << u << ' ' << v;
  }
}

TEST(Renderer, FarTexturesFadeToTheirMeanInsteadOfFlickering) {
  const ReflectanceImage image =
      paint_tiles(64, Eigen::Vector3f::Constant(0.9F), Eigen::Vector3f::Constant(0.1F), 8, 3);
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& texel : image.data) mean += texel / static_cast<float>(image.data.size());
  // A repeat is a fifth of a pixel wide.
  const Renderer renderer(textured_plane(image, 0.2F / 150, 1));
  Image<Eigen::Vector3f> light;
  renderer.render_light(test_camera(), kAtOrigin, {0.1, 0.2}, Workers(1), light);
  for (const Eigen::Vector3f& pixel : light.data) ASSERT_NEAR(pixel.x(), mean.x(), 1e-3);
}

TEST(Renderer, EachRowHasItsPose) {
  RowPoses poses;
  const PinholeCamera camera = test_camera();
  for (int row = 0; row < camera.height_px; ++row)
    poses.T_world_camera.push_back({Quaterniond::Identity(), {0, 0, 0.001 * row}});
  Image<Renderer::Surface> surfaces;
  Renderer(plane_at(2, 0)).render_surfaces(camera, poses, Workers(2), surfaces);
  for (int row = 0; row < camera.height_px; ++row)
    ASSERT_NEAR(surfaces(40, row).depth_m, 2 - 0.001 * row, 1e-5);
}

TEST(Renderer, SmallAndOddImagesAreWholeToo) {
  const Renderer renderer(plane_at(2, 0));
  for (const int width : {1, 3, 8, 13}) {
    PinholeCamera camera = test_camera();
    camera.width_px = width;
    camera.height_px = 3;
    Image<Renderer::Surface> surfaces;
    renderer.render_surfaces(camera, kAtOrigin, Workers(1), surfaces);
    for (const auto& surface : surfaces.data) ASSERT_NEAR(surface.depth_m, 2, 1e-5);
  }
}

}  // namespace
}  // namespace fusebench
