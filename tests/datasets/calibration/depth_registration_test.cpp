#include "datasets/calibration/depth_registration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "tests/support/two_cameras.hpp"

namespace fusebench {

using namespace calibration;

namespace {

using testing::RegistrationQuality;
using testing::TexturedRoom;
using testing::TwoCameras;

/// A wall at 3 m with a plate of 0.8 x 0.6 m before it, seen from the depth camera.
struct PlateBeforeWall {
  static constexpr double kPlate_m = 1.0;
  static constexpr double kWall_m = 3.0;
  TexturedRoom room{Eigen::AlignedBox3d(Vector3d(-20, -20, -1), Vector3d(20, 20, kWall_m)),
                    {Eigen::AlignedBox3d(Vector3d(-0.4, -0.3, kPlate_m), Vector3d(0.4, 0.3, 1.0001))}};
  TwoCameras cameras;
  DepthImage registered_m;

  /// to_the_right: as on a ZR300; else the colour camera is as far on the other side.
  explicit PlateBeforeWall(bool to_the_right = true) {
    if (!to_the_right) cameras.T_color_depth.translation.x() *= -1;
    registered_m = DepthRegistration(cameras.depth, cameras.color, cameras.T_color_depth)
                       .register_depth(testing::exact_depth(room, cameras.depth, SE3{}));
  }

  /// True depth in the colour camera, at a pixel or between pixels.
  [[nodiscard]] double truth_m(double u_px, double v_px) const {
    return testing::exact_depth_m(room, cameras.color, cameras.T_color_depth.inverse(), u_px, v_px);
  }
};

bool is_plate(double depth_m) { return std::abs(depth_m - PlateBeforeWall::kPlate_m) < 0.2; }

TEST(DepthRegistration, TheSameCameraKeepsThePixels) {
  const PinholeCamera camera{6, 5, 20, 21, 2.5, 2};
  DepthImage depth_m(6, 5);
  for (std::size_t i = 0; i < depth_m.data.size(); ++i)
    depth_m.data[i] = i % 4 == 0 ? 0.0F : 1.0F + 0.5F * static_cast<float>(i % 7);
  const DepthImage registered_m = DepthRegistration(camera, camera, {}).register_depth(depth_m);
  for (std::size_t i = 0; i < depth_m.data.size(); ++i)
    EXPECT_NEAR(registered_m.data[i], depth_m.data[i], 1e-6) << i;
}

/// A depth whose inverse is infinite has no place in the image: it was drawn before the image's memory.
TEST(DepthRegistration, WhatHasNoPlaceIsNotDrawn) {
  const PinholeCamera camera{6, 5, 20, 21, 2.5, 2};
  for (const float tiny : {1e-45F, 1e-40F, 3e-39F}) {
    DepthImage depth_m(6, 5);
    depth_m(2, 2) = tiny;
    depth_m(4, 3) = 2;
    const DepthImage registered_m = DepthRegistration(camera, camera, {}).register_depth(depth_m);
    EXPECT_EQ(std::ranges::count_if(registered_m.data, [](float z) { return z > 1; }), 1) << tiny;
    EXPECT_NEAR(registered_m(4, 3), 2, 1e-6);
  }
}

TEST(DepthRegistration, ProjectsByTheTransform) {
  // 0.1 m to the right of the depth camera and 0.5 m behind it: a point at 2 m is at 2.5 m, 100 * 0.1 / 2.5
  // px to the left.
  const PinholeCamera camera{40, 30, 100, 100, 20, 15};
  DepthImage depth_m(40, 30);
  depth_m(20, 15) = 2.0F;
  const DepthImage registered_m =
      DepthRegistration(camera, camera, {Quaterniond::Identity(), {-0.1, 0, 0.5}}).register_depth(depth_m);
  EXPECT_FLOAT_EQ(registered_m(16, 15), 2.5F);
  EXPECT_EQ(std::ranges::count_if(registered_m.data, [](float z) { return z > 0; }), 1);
}

TEST(DepthRegistration, MeasurementsBehindTheColourCameraAreDropped) {
  const PinholeCamera camera{8, 6, 10, 10, 3.5, 2.5};
  const DepthImage registered_m = DepthRegistration(camera, camera, {Quaterniond::Identity(), {0, 0, -2}})
                                      .register_depth(DepthImage(8, 6, 1.5F));
  EXPECT_TRUE(std::ranges::all_of(registered_m.data, [](float z) { return z == 0; }));
}

TEST(DepthRegistration, TheSizeIsChecked) {
  const PinholeCamera camera{8, 6, 10, 10, 3.5, 2.5};
  EXPECT_THROW((void)DepthRegistration(camera, camera, {}).register_depth(DepthImage(6, 8)), InternalError);
}

TEST(DepthRegistration, SlantedSurfacesHaveNoHoles) {
  // A floor and side walls seen at grazing angles, turned against the rows. On the wall to the left,
  // measurements land 1.4 px apart in the colour image.
  const TexturedRoom room{Eigen::AlignedBox3d(Vector3d(-0.15, -0.6, -1), Vector3d(0.8, 0.7, 1.5)), {}};
  const TwoCameras cameras;
  const DepthRegistration registration(cameras.depth, cameras.color, cameras.T_color_depth);
  for (const double roll_deg : {0.0, 3.0, 20.0}) {
    const SE3 T_world_depth{so3_exp({0.05, 0.1, radians(roll_deg)}), {0, 0, 0}};
    RegistrationQuality quality;
    quality.add(room, cameras, T_world_depth,
                registration.register_depth(testing::exact_depth(room, cameras.depth, T_world_depth)));
    EXPECT_EQ(quality.missed, 0U) << roll_deg;
    EXPECT_EQ(quality.too_near + quality.too_far, 0U) << roll_deg;
    EXPECT_LT(quality.error_quantile_m(0.5), 1e-4) << roll_deg;
    EXPECT_LT(quality.error_quantile_m(0.99), 5e-3) << roll_deg;
  }
}

TEST(DepthRegistration, TheWallDoesNotLeakThroughThePlate) {
  for (const bool to_the_right : {true, false}) {
    const PlateBeforeWall scene(to_the_right);
    int inside = 0;
    int wrong = 0;
    for (int y = 0; y < scene.registered_m.height; ++y) {
      for (int x = 0; x < scene.registered_m.width; ++x) {
        // The whole pixel and its neighbours are plate.
        const bool plate = is_plate(scene.truth_m(x - 1, y - 1)) && is_plate(scene.truth_m(x + 1, y - 1)) &&
                           is_plate(scene.truth_m(x - 1, y + 1)) && is_plate(scene.truth_m(x + 1, y + 1));
        if (!plate) continue;
        ++inside;
        if (!(std::abs(scene.registered_m(x, y) - scene.truth_m(x, y)) < 1e-4)) ++wrong;
      }
    }
    EXPECT_GT(inside, 480 * 350);
    EXPECT_EQ(wrong, 0) << "of " << inside << (to_the_right ? ", to the right" : ", to the left");
  }
}

TEST(DepthRegistration, EdgesAreNotFattened) {
  const PlateBeforeWall scene;
  int outside = 0;
  int shadow = 0;
  for (int y = 0; y < scene.registered_m.height; ++y) {
    for (int x = 0; x < scene.registered_m.width; ++x) {
      const bool wall = !is_plate(scene.truth_m(x - 1, y - 1)) && !is_plate(scene.truth_m(x + 1, y - 1)) &&
                        !is_plate(scene.truth_m(x - 1, y + 1)) && !is_plate(scene.truth_m(x + 1, y + 1));
      if (!wall) continue;
      ++outside;
      EXPECT_FALSE(is_plate(scene.registered_m(x, y))) << x << " " << y;
      if (scene.registered_m(x, y) == 0) ++shadow;
    }
  }
  // What the plate hides from the depth camera stays empty: 57.46 mm * 608 px * (1 / 1 m - 1 / 3 m) = 23 px
  // beside the plate, which is 365 px high; the pixels at its borders are not counted.
  EXPECT_GT(outside, 100'000);
  EXPECT_GT(shadow, 21 * 360);
  EXPECT_LT(shadow, 24 * 370);
}

TEST(DepthRegistration, TheNearestWins) {
  const PinholeCamera camera{40, 30, 100, 100, 20, 15};
  for (const int side : {-1, 1}) {  // so that the nearer one comes first, or last
    const DepthRegistration registration(camera, camera, {Quaterniond::Identity(), {0.2 * side, 0, 0}});
    DepthImage depth_m(40, 30);
    depth_m(20 - 5 * side, 15) = 4.0F;   // moves by 5 px
    depth_m(20 - 10 * side, 15) = 2.0F;  // moves by 10 px
    EXPECT_FLOAT_EQ(registration.register_depth(depth_m)(20, 15), 2.0F);
    depth_m(20 - 10 * side, 15) = 0.0F;
    EXPECT_FLOAT_EQ(registration.register_depth(depth_m)(20, 15), 4.0F);
  }
}

TEST(DepthRegistration, BoxesInARoomAreWhereTheColourCameraSeesThem) {
  const TwoCameras cameras;
  const TexturedRoom room;
  const DepthRegistration registration(cameras.depth, cameras.color, cameras.T_color_depth);
  RegistrationQuality quality;
  const SE3 T_world_depth = testing::registration_views()[1];
  quality.add(room, cameras, T_world_depth,
              registration.register_depth(testing::exact_depth(room, cameras.depth, T_world_depth)));
  const auto share = [](std::size_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(whole);
  };
  EXPECT_GT(share(quality.with_depth, quality.pixels), 0.9);
  EXPECT_LT(share(quality.missed, quality.seen_by_both), 1e-3);
  EXPECT_LT(share(quality.too_near + quality.too_far, quality.with_depth), 2e-3);
  EXPECT_LT(quality.error_quantile_m(0.95), 1e-3);
}

}  // namespace
}  // namespace fusebench
