#include <gtest/gtest.h>

#include <cmath>

#include "datasets/simulator/scene/room.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "tests/datasets/simulator/simple_scenes.hpp"

namespace fusebench {

using namespace simulator::scene;
using namespace simulator::render;
using namespace simulator::sensors;

namespace {

using testing::add_rectangle;
using testing::kHalfSecond_ns;
using testing::plane_at;
using testing::straight_motion;

// The size in which a Kinect measures, and half of it.
constexpr PinholeCamera kNative{640, 480, 480.0, 480.0, 319.5, 239.5};
constexpr PinholeCamera kHalved{320, 240, 240.0, 240.0, 159.5, 119.5};

// A part of the native image with its focal length: a ZR300 measures in the size of its image.
constexpr PinholeCamera kMiddle{320, 240, 480.0, 480.0, 159.5, 119.5};

DepthSensor sensor_with(DepthNoise noise, const PinholeCamera& camera) {
  DepthSensor sensor;
  sensor.camera = camera;
  sensor.units_per_metre = 5000;
  sensor.noise = noise;
  return sensor;
}

DepthSensor sensor_with(DepthNoise noise) {
  return sensor_with(noise, noise == DepthNoise::zr300 ? kMiddle : kHalved);
}

Image<std::uint16_t> sense(const SimulatedScene& scene, const DepthSensor& sensor, std::uint64_t seed = 1,
                           std::uint64_t frame = 0, int threads = 1) {
  return sense_depth(Renderer(scene), sensor, straight_motion(Vector3d::Zero()), {}, kHalfSecond_ns, seed,
                     frame, Workers(threads));
}

/// Statistics of the error of measured pixels against a constant depth, away from the image border.
struct DepthError {
  double mean_m = 0;
  double deviation_m = 0;
  double share_measured = 0;
};
DepthError error_against(const Image<std::uint16_t>& raw, double units_per_metre, double depth_m) {
  double sum = 0, squares = 0, count = 0, all = 0;
  for (int v = 20; v < raw.height - 20; ++v) {
    for (int u = raw.width / 4; u < raw.width - 20; ++u) {
      ++all;
      if (raw(u, v) == 0) continue;
      const double error = raw(u, v) / units_per_metre - depth_m;
      sum += error;
      squares += error * error;
      ++count;
    }
  }
  return {sum / count, std::sqrt(squares / count - sum * sum / (count * count)), count / all};
}

TEST(DepthSensor, WithoutNoiseIsExactToTheQuantum) {
  DepthSensor sensor = sensor_with(DepthNoise::none);
  for (const double units : {1000.0, 5000.0}) {
    sensor.units_per_metre = units;
    for (const float depth_m : {0.3F, 1.23456F, 4.9F}) {
      const auto raw = sense(plane_at(depth_m, 0), sensor);
      for (const std::uint16_t value : raw.data) ASSERT_NEAR(value, depth_m * units, 0.51);
    }
  }
  for (const std::uint16_t value : sense(plane_at(14, 0), sensor).data) ASSERT_EQ(value, 0);  // 70000 units
}

TEST(DepthSensor, RowsAreTakenOneAfterTheOther) {
  DepthSensor sensor = sensor_with(DepthNoise::none);
  sensor.readout_s = 0.03;
  const auto raw = sense_depth(Renderer(plane_at(3, 0)), sensor, straight_motion({0, 0, 1}), {},
                               kHalfSecond_ns, 1, 0, Workers(2));
  for (const int row : {0, 100, 239})
    EXPECT_NEAR(raw(7, row) / 5000.0, 3 - 0.03 * (row / 239.0 - 0.5), 1.5e-4);
}

TEST(DepthSensor, NoiseGrowsWithTheSquareOfDepth) {
  for (const DepthNoise noise : {DepthNoise::handa, DepthNoise::zr300}) {
    std::vector<double> ratios;
    // Nearer than 2 m, structured light is as coarse as its centimetres.
    for (const float depth_m : {noise == DepthNoise::handa ? 1.9F : 1.03F, 2.11F, 2.6F, 3.5F}) {
      // Disparities of a plane at one depth would all be rounded the same way, so the error is averaged over
      // depths.
      double squares = 0;
      for (int i = 0; i < 8; ++i) {
        const float at = depth_m * (1 + 0.006F * static_cast<float>(i));
        const DepthError error = error_against(sense(plane_at(at, 0), sensor_with(noise)), 5000, at);
        EXPECT_GT(error.share_measured, 0.98) << at;
        squares +=
            (error.mean_m * error.mean_m + error.deviation_m * error.deviation_m) / std::pow(at, 4) / 8;
      }
      ratios.push_back(std::sqrt(squares));
    }
    for (const double ratio : ratios) EXPECT_NEAR(ratio, ratios.front(), 0.25 * ratios.front());
  }
}

TEST(DepthSensor, ActiveStereoHasTheStatedDisparityNoise) {
  const double depth_m = 2;
  const DepthError error =
      error_against(sense(plane_at(2, 0), sensor_with(DepthNoise::zr300)), 5000, depth_m);
  const double focal_baseline = 480 * 0.07;
  const double disparity_px = std::hypot(0.09, 1 / (32 * std::sqrt(12.0)));
  EXPECT_NEAR(error.deviation_m, depth_m * depth_m / focal_baseline * disparity_px, 0.06 * error.deviation_m);
  EXPECT_LT(std::abs(error.mean_m), 0.1 * error.deviation_m);
}

TEST(DepthSensor, ASmallerImageOfAKinectIsAsExactInMetres) {
  for (const DepthNoise noise : {DepthNoise::handa, DepthNoise::kinect}) {
    const auto error = [&](const PinholeCamera& camera) {
      return error_against(sense(plane_at(2.5F, 0), sensor_with(noise, camera)), 5000, 2.5);
    };
    const DepthError native = error(kNative);
    const DepthError halved = error(kHalved);
    EXPECT_NEAR(halved.deviation_m, native.deviation_m, 0.1 * native.deviation_m);
    EXPECT_NEAR(halved.mean_m, native.mean_m, 0.2 * native.deviation_m);
    EXPECT_NEAR(halved.share_measured, native.share_measured, 0.01);
  }
}

TEST(DepthSensor, ASmallerImageOfAZr300IsTwiceAsCoarse) {
  const auto deviation_m = [&](const PinholeCamera& camera) {
    return error_against(sense(plane_at(2.5F, 0), sensor_with(DepthNoise::zr300, camera)), 5000, 2.5)
        .deviation_m;
  };
  EXPECT_NEAR(deviation_m(kHalved), 2 * deviation_m(kNative), 0.1 * deviation_m(kHalved));
}

TEST(DepthSensor, StructuredLightIsUnbiasedAndQuantised) {
  // Depth steps of the Kinect at 2 m: 100 z^2 / 35130 = 11 mm.
  double mean = 0;
  for (int i = 0; i < 10; ++i) {
    const float at = 2 + 0.011F * static_cast<float>(i);
    mean += error_against(sense(plane_at(at, 0), sensor_with(DepthNoise::handa)), 5000, at).mean_m / 10;
  }
  EXPECT_LT(std::abs(mean), 0.002);
  for (const std::uint16_t value : sense(plane_at(2, 0), sensor_with(DepthNoise::handa)).data) {
    if (value == 0) continue;
    const double steps = 35130 / (100 * value / 5000.0);
    ASSERT_NEAR(steps, std::round(steps), 0.02);
  }
}

/// A board at 1 m in front of a wall at 2 m, left edge at column 319.5 of the native image.
SimulatedScene board_before_wall() {
  SimulatedScene scene = plane_at(2, 0);
  add_rectangle(scene, {0, -0.15F, 1}, {0.25F, 0, 0}, {0, 0.3F, 0}, 0);
  return scene;
}

TEST(DepthSensor, HolesAreAtDepthEdges) {
  for (const DepthNoise noise : {DepthNoise::handa, DepthNoise::zr300}) {
    const auto raw = sense(board_before_wall(), sensor_with(noise, kNative));
    const auto holes = [&](int first, int last) {
      int count = 0;
      for (int v = 210; v < 270; ++v) {
        for (int u = first; u < last; ++u) count += raw(u, v) == 0 ? 1 : 0;
      }
      return static_cast<double>(count) / (60 * (last - first));
    };
    EXPECT_LT(holes(250, 290), 0.03);  // on the wall
    EXPECT_LT(holes(350, 400), 0.03);  // on the board
    EXPECT_GT(holes(315, 325) + holes(436, 444), 0.05);
  }
}

TEST(DepthSensor, ActiveStereoDoesNotSeeWhatTheRightCameraDoesNot) {
  // The board shifts by 480 * 0.07 / 1 = 33.6 px in the right image, the wall by 16.8. Left of the board, the
  // difference is occluded on the wall, as is the left band of the wall outside the right image.
  const auto raw = sense(board_before_wall(), sensor_with(DepthNoise::zr300, kNative));
  for (int v = 210; v < 270; ++v) {
    for (int u = 305; u < 318; ++u) ASSERT_EQ(raw(u, v), 0) << u;
    ASSERT_GT(raw(298, v), 0);
    ASSERT_GT(raw(450, v), 0);  // no shadow to the right
  }
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 16; ++u) ASSERT_EQ(raw(u, v), 0);
  }
  EXPECT_GT(raw(19, 20), 0);
}

TEST(DepthSensor, ActiveStereoHasARange) {
  const auto measured = [](float depth_m) {
    return error_against(sense(plane_at(depth_m, 0), sensor_with(DepthNoise::zr300)), 5000, depth_m)
        .share_measured;
  };
  EXPECT_EQ(measured(0.5F), 0);  // 480 * 0.07 / 63 = 0.533 m
  EXPECT_GT(measured(0.57F), 0.99);
  EXPECT_GT(measured(3.9F), 0.99);
  EXPECT_NEAR(measured(5.0F), 0.5, 0.05);
  EXPECT_EQ(measured(6.1F), 0);
}

TEST(DepthSensor, NothingIsMeasuredAtGrazingAngles) {
  SimulatedScene floor;  // 5 cm below the camera
  add_rectangle(floor, {-20, 0.05F, 0.1F}, {40, 0, 0}, {0, 0, 60}, 0);
  for (const DepthNoise noise : {DepthNoise::handa, DepthNoise::zr300}) {
    const auto raw = sense(floor, sensor_with(noise));
    // At row v the angle between ray and floor is atan((v - cy) / f): at most 7.2 degrees here.
    const int row = noise == DepthNoise::zr300 ? 180 : 150;
    for (int u = 0; u < raw.width; ++u) ASSERT_EQ(raw(u, row), 0);
  }
}

TEST(DepthSensor, TheSameBytesForAnyThreadsAndOthersForOtherSeeds) {
  const SimulatedScene room = make_room(3);
  const Renderer renderer(room);
  const SE3 T_body_camera{so3_exp({-1.6, 0.2, 0.1}), room.free_space.center()};
  for (const DepthNoise noise : {DepthNoise::none, DepthNoise::handa, DepthNoise::zr300}) {
    const auto image = [&](std::uint64_t seed, std::uint64_t frame, int threads) {
      return sense_depth(renderer, sensor_with(noise), straight_motion(Vector3d::Zero()), T_body_camera,
                         kHalfSecond_ns, seed, frame, Workers(threads))
          .data;
    };
    const auto one = image(1, 0, 1);
    EXPECT_EQ(one, image(1, 0, 2));
    EXPECT_EQ(one, image(1, 0, 3));
    if (noise == DepthNoise::none) continue;
    EXPECT_NE(one, image(2, 0, 1));
    EXPECT_NE(one, image(1, 1, 1));
  }
}

}  // namespace
}  // namespace fusebench
