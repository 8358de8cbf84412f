#include "core/baselines/elasticfusion/surfels/surfel_view.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace fusebench {

using namespace baselines::elasticfusion::surfels;

namespace {

const PinholeCamera kDiscCamera = {67, 45, 60, 62, 33, 22};

/// Discs all over the view, some of them behind others, beyond the border, or of no use.
SurfelMap random_discs(std::size_t count) {
  std::mt19937 generator(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(generator()) / static_cast<double>(generator.max());
  };
  SurfelMap map;
  for (std::size_t i = 0; i < count; ++i) {
    Surfel surfel;
    const double z = uniform(0.5, 3);
    surfel.position = kDiscCamera.back_project(uniform(-5, 72), uniform(-5, 50), z).cast<float>();
    surfel.normal = Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-2, 0.2)).normalized().cast<float>();
    surfel.color = {static_cast<std::uint8_t>(i), 0, 0};
    surfel.radius_m = static_cast<float>(uniform(0.01, 0.08));
    surfel.confidence = static_cast<float>(uniform(5, 15));
    surfel.updated = static_cast<std::int32_t>(uniform(0, 100));
    map.add(surfel);
  }
  return map;
}

const SurfelChoice kChoice{100, 60, true, 10};

TEST(SurfelView, EachPixelSeesTheNearestDiscOfTheChoice) {
  const SurfelMap map = random_discs(600);
  const SE3 T_world_camera{so3_exp({0.02, -0.03, 0.1}), {0.02, 0.01, -0.05}};
  ViewRenderer renderer;
  SurfelView view;
  renderer.render(map, kDiscCamera, T_world_camera, kChoice, Workers(1), view);
  const SE3 T_camera_world = T_world_camera.inverse();
  std::size_t seen = 0;
  for (int y = 0; y < kDiscCamera.height_px; ++y) {
    for (int x = 0; x < kDiscCamera.width_px; ++x) {
      const Vector3d ray = kDiscCamera.back_project(x, y, 1);
      double nearest = std::numeric_limits<double>::infinity();
      std::int32_t expected = kNoSurfel;
      for (std::size_t i = 0; i < map.size(); ++i) {
        if (map.updated[i] < 40 || !(map.confidence[i] > 10)) continue;
        const Vector3d middle = T_camera_world * map.position[i].cast<double>();
        const Vector3d normal = T_camera_world.rotation * map.normal[i].cast<double>();
        if (!(normal.dot(middle) < 0) || !(normal.dot(ray) < 0)) continue;
        const double depth = normal.dot(middle) / normal.dot(ray);
        if ((depth * ray - middle).norm() > static_cast<double>(map.radius_m[i]) || depth >= nearest)
          continue;
        nearest = depth;
        expected = static_cast<std::int32_t>(i);
      }
      EXPECT_EQ(view.surfel(x, y), expected) << x << " " << y;
      if (expected == kNoSurfel) {
        EXPECT_EQ(view.point.z(x, y), 0);
        continue;
      }
      ++seen;
      EXPECT_NEAR(static_cast<double>(view.point.z(x, y)), nearest, 1e-4);
      EXPECT_EQ(view.color(x, y)[0], static_cast<std::uint8_t>(expected));
    }
  }
  EXPECT_EQ(view.seen, seen);
  EXPECT_GT(seen, 200U);
}

TEST(SurfelView, IsTheSameForAnyNumberOfThreads) {
  const SurfelMap map = random_discs(600);
  SurfelView one, three;
  ViewRenderer renderer;
  renderer.render(map, kDiscCamera, SE3{}, kChoice, Workers(1), one);
  renderer.render(map, kDiscCamera, SE3{}, kChoice, Workers(3), three);
  EXPECT_EQ(one.surfel.data, three.surfel.data);
  EXPECT_EQ(one.point.z.data, three.point.z.data);
  EXPECT_EQ(one.seen, three.seen);
}

TEST(SurfelView, LiveDataFillsTheHoles) {
  LiveFrame live;
  live.smooth_m = DepthImage(kDiscCamera.width_px, kDiscCamera.height_px, 2.0F);
  live.normal.resize(kDiscCamera.width_px, kDiscCamera.height_px);
  std::ranges::fill(live.normal.z.data, -1.0F);
  live.color = ColorImage(kDiscCamera.width_px, kDiscCamera.height_px, {1, 2, 3});
  SurfelView view;
  ViewRenderer renderer;
  renderer.render(random_discs(40), kDiscCamera, SE3{}, kChoice, Workers(1), view);
  const SurfelView before = view;
  fill_in(live, view);
  for (std::size_t pixel = 0; pixel < view.surfel.data.size(); ++pixel) {
    const bool known = before.surfel.data[pixel] != kNoSurfel;
    EXPECT_EQ(view.point.z.data[pixel], known ? before.point.z.data[pixel] : 2.0F);
    EXPECT_EQ(view.color.data[pixel], known ? before.color.data[pixel] : (Rgb{1, 2, 3}));
  }
  EXPECT_GT(before.seen, 0U);
  EXPECT_LT(before.share(), 0.75);
}

}  // namespace
}  // namespace fusebench
