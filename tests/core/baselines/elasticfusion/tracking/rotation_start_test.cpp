#include "core/baselines/elasticfusion/tracking/rotation_start.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/baselines/image_gradient.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace baselines;
using namespace baselines::elasticfusion;
using testing::small_camera;

namespace {

tracking::LiveLevel level_of(const GreyImage& grey, const PinholeCamera& camera) {
  tracking::LiveLevel level;
  level.camera = camera;
  level.intensity = Image<float>(grey.width, grey.height);
  std::ranges::copy(grey.data, level.intensity.data.begin());
  level.gradient = gradient_of(level.intensity);
  return level;
}

TEST(RotationStart, FindsAPureRotation) {
  const PinholeCamera camera = tracking::camera_of_level(small_camera(), 1);
  const testing::TexturedRoom room;
  const Quaterniond turn = so3_exp({0.012, -0.02, 0.015});
  const auto before = level_of(room.render(camera, SE3{}, 0).grey, camera);
  const auto now = level_of(room.render(camera, {turn, Vector3d::Zero()}, 0).grey, camera);
  EXPECT_LT(rotation_angle_rad(tracking::rotation_between(before, now), turn), 0.002);
  const auto blank = level_of(GreyImage(camera.width_px, camera.height_px, 90), camera);
  EXPECT_EQ(tracking::rotation_between(blank, blank).coeffs(), Quaterniond::Identity().coeffs());
}

/// A sphere of tiles of random brightness, 2.5 pixels wide and high; each pixel is the mean of 16 rays.
GreyImage sphere_of_tiles(const PinholeCamera& camera, const Quaterniond& R_world_camera) {
  constexpr int kSide = 400;
  std::mt19937 random(1);
  std::vector<int> brightness(kSide * kSide);
  for (int& value : brightness) value = 40 + static_cast<int>(random() % 180);
  const auto tile = [&](double along, double depth) {
    return static_cast<int>(std::floor(std::atan2(along, depth) * camera.fx_px / 2.5)) + kSide / 2;
  };
  GreyImage image(camera.width_px, camera.height_px);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      int sum = 0;
      for (int part = 0; part < 16; ++part) {
        const double across = -0.375 + 0.25 * (part % 4), down = -0.375 + 0.25 * (part / 4);
        const Vector3d ray = R_world_camera * camera.back_project(x + across, y + down, 1.0);
        sum += brightness[static_cast<std::size_t>(tile(ray.y(), ray.z()) * kSide + tile(ray.x(), ray.z()))];
      }
      image(x, y) = static_cast<std::uint8_t>(sum / 16);
    }
  }
  return image;
}

// With the gradient of one of the images alone it ends 2.5 pixels off.
TEST(RotationStart, FindsATurnThatIsLargerThanTheTexture) {
  const PinholeCamera camera = tracking::camera_of_level(small_camera(), 1);
  const double pixel_rad = 1 / camera.fx_px;
  const Quaterniond turn = so3_exp({0.6 * pixel_rad, 3 * pixel_rad, 0});
  const auto before = level_of(sphere_of_tiles(camera, Quaterniond::Identity()), camera);
  const auto now = level_of(sphere_of_tiles(camera, turn), camera);
  EXPECT_LT(rotation_angle_rad(tracking::rotation_between(before, now), turn), 0.1 * pixel_rad);
}

}  // namespace
}  // namespace fusebench
