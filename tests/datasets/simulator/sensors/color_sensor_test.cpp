#include <gtest/gtest.h>

#include <cmath>

#include "datasets/simulator/scene/room.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "datasets/simulator/texture/texture.hpp"
#include "tests/datasets/simulator/simple_scenes.hpp"

namespace fusebench {

using namespace simulator::texture;
using namespace simulator::scene;
using namespace simulator::render;
using namespace simulator::sensors;

namespace {

using testing::edge_at;
using testing::kHalfSecond_ns;
using testing::kWhite;
using testing::plane_at;
using testing::straight_motion;
using testing::test_camera;

ColorSensor ideal_sensor(int samples) {
  ColorSensor sensor;
  sensor.camera.pinhole = test_camera();
  sensor.blur_samples = samples;
  return sensor;
}

ColorImage expose(const SimulatedScene& scene, const ColorSensor& sensor, const Vector3d& velocity_mps,
                  std::uint64_t seed = 1, std::uint64_t frame = 0, int threads = 1) {
  return expose_color(Renderer(scene), sensor, straight_motion(velocity_mps), {}, kHalfSecond_ns, seed, frame,
                      Workers(threads));
}

double light_of(const Rgb& pixel) { return linear_from_srgb(pixel[0] / 255.0); }

/// Where the edge from black to white lies in a row: the column up to which white would have to be black.
double edge_column(const ColorImage& image, int row) {
  double dark = 0;
  for (int u = 0; u < image.width; ++u) dark += 1 - light_of(image(u, row));
  return dark - 0.5;
}

TEST(ColorSensor, KeepsAColour) {
  for (const std::uint8_t grey : {0, 1, 7, 64, 128, 200, 255}) {
    EXPECT_EQ(expose(plane_at(2, grey), ideal_sensor(8), Vector3d::Zero())(80, 60), (Rgb{grey, grey, grey}));
  }
}

TEST(ColorSensor, AnEdgeAtRestIsAntialiasedWhereItIs) {
  ColorSensor sensor = ideal_sensor(8);
  for (const double shift : {0.0, 0.3, 0.5, 0.8}) {
    sensor.camera.pinhole.cx_px = 79.5 + shift;
    const ColorImage image = expose(edge_at(1), sensor, Vector3d::Zero());
    EXPECT_NEAR(edge_column(image, 60), 79.5 + shift, 0.13) << shift;
    EXPECT_EQ(image(78, 60)[0], 0);
    EXPECT_EQ(image(82, 60)[0], kWhite);
  }
}

TEST(ColorSensor, BlurIsAsLongAsTheMotionAndMixesLightNotGreyLevels) {
  ColorSensor sensor = ideal_sensor(64);
  sensor.exposure_s = 0.02;
  sensor.camera.pinhole.cx_px = 80;  // the edge passes the middle of pixel 80 at the middle of the exposure
  const double speed_mps = 5;        // 150 px/m * 5 m/s * 0.02 s = 15 px at 1 m
  const ColorImage image = expose(edge_at(1), sensor, {speed_mps, 0, 0});
  EXPECT_NEAR(image(80, 60)[0], 188, 2);  // half the light; half the grey level would be 128
  int between = 0;
  for (int u = 0; u < image.width; ++u) {
    const double expected = std::clamp((u - 80) / 15.0 + 0.5, 0.0, 1.0);
    EXPECT_NEAR(light_of(image(u, 60)), expected, 0.04) << u;
    const double light = light_of(image(u, 60));
    if (light > 0.02 && light < 0.98) ++between;
  }
  EXPECT_NEAR(between, 15, 1);
  EXPECT_NEAR(edge_column(image, 60), 80, 0.1);  // the blur does not move the edge
}

TEST(ColorSensor, ARollingShutterShears) {
  ColorSensor sensor = ideal_sensor(16);
  sensor.exposure_s = 0;
  sensor.camera.timing.color_readout_s = 0.03;
  const ColorImage image = expose(edge_at(1), sensor, {2, 0, 0});
  for (const int row : {0, 20, 60, 90, 119}) {
    const double after_s = 0.03 * (row / 119.0 - 0.5);
    EXPECT_NEAR(edge_column(image, row), 79.5 - 150 * 2 * after_s, 0.15) << row;
  }
}

TEST(ColorSensor, DistortionIsThatOfTheCameraModel) {
  ColorSensor sensor = ideal_sensor(16);
  sensor.camera.distortion = {0.26, -0.95, -0.005, 0.0026, 1.16};
  // An upright edge at x = 0.3 on the plane at 1 m: a curve in the image.
  const SE3 T_body_camera{Quaterniond::Identity(), {-0.3, 0, 0}};
  const ColorImage image = expose_color(Renderer(edge_at(1)), sensor, straight_motion(Vector3d::Zero()),
                                        T_body_camera, kHalfSecond_ns, 1, 0, Workers(1));
  const PinholeCamera& camera = sensor.camera.pinhole;
  for (const double y : {-0.3, 0.0, 0.25}) {
    const Vector2d distorted = sensor.camera.distortion.distort({0.3, y});
    const double u = camera.fx_px * distorted.x() + camera.cx_px;
    const double v = camera.fy_px * distorted.y() + camera.cy_px;
    const int row = static_cast<int>(std::floor(v));
    const double column =
        edge_column(image, row) + (v - row) * (edge_column(image, row + 1) - edge_column(image, row));
    EXPECT_NEAR(column, u, 0.15) << y;
    EXPECT_GT(std::abs(u - (camera.fx_px * 0.3 + camera.cx_px)), 0.4);  // so the test sees the distortion
  }
}

/// Mean and standard deviation over an image, first channel.
std::array<double, 2> statistics_of(const ColorImage& image) {
  double sum = 0;
  double squares = 0;
  for (const Rgb& pixel : image.data) {
    sum += pixel[0];
    squares += pixel[0] * pixel[0];
  }
  const auto count = static_cast<double>(image.data.size());
  return {sum / count, std::sqrt(squares / count - sum * sum / (count * count))};
}

TEST(ColorSensor, NoiseIsAsStated) {
  ColorSensor sensor = ideal_sensor(1);
  sensor.read_noise_grey = 2.5;
  const auto [mean, deviation] = statistics_of(expose(plane_at(2, 128), sensor, Vector3d::Zero()));
  EXPECT_NEAR(mean, 128, 0.06);
  EXPECT_NEAR(deviation, std::sqrt(2.5 * 2.5 + 1.0 / 12), 0.05);
  sensor.read_noise_grey = 0;
  sensor.shot_noise = 0.02;
  for (const std::uint8_t grey : {60, 128, 220}) {
    const double light = linear_from_srgb(grey / 255.0);
    const double slope = 255 * (srgb_from_linear(light + 1e-4) - srgb_from_linear(light - 1e-4)) / 2e-4;
    const double expected = std::hypot(slope * 0.02 * std::sqrt(light), 1 / std::sqrt(12.0));
    EXPECT_NEAR(statistics_of(expose(plane_at(2, grey), sensor, Vector3d::Zero()))[1], expected,
                0.04 * expected);
  }
}

TEST(ColorSensor, NoiseOfPixelsChannelsAndFramesIsIndependent) {
  ColorSensor sensor = ideal_sensor(1);
  sensor.read_noise_grey = 10;
  const ColorImage a = expose(plane_at(2, 128), sensor, Vector3d::Zero(), 1, 0);
  const ColorImage b = expose(plane_at(2, 128), sensor, Vector3d::Zero(), 1, 1);
  double neighbours = 0, channels = 0, frames = 0;
  for (std::size_t i = 0; i + 1 < a.data.size(); ++i) {
    neighbours += (a.data[i][0] - 128.0) * (a.data[i + 1][0] - 128.0);
    channels += (a.data[i][0] - 128.0) * (a.data[i][1] - 128.0);
    frames += (a.data[i][0] - 128.0) * (b.data[i][0] - 128.0);
  }
  const double four_sigmas = 4 * 100 * std::sqrt(static_cast<double>(a.data.size()));
  EXPECT_LT(std::abs(neighbours), four_sigmas);
  EXPECT_LT(std::abs(channels), four_sigmas);
  EXPECT_LT(std::abs(frames), four_sigmas);
}

TEST(ColorSensor, VignettingAndGain) {
  ColorSensor sensor = ideal_sensor(1);
  sensor.vignetting = 0.4;
  const ColorImage image = expose(plane_at(2, 200), sensor, Vector3d::Zero());
  const double light = linear_from_srgb(200 / 255.0);
  EXPECT_NEAR(light_of(image(80, 60)), light, 0.01);
  EXPECT_NEAR(light_of(image(0, 0)), 0.6 * light, 0.01);
  EXPECT_NEAR(light_of(image(159, 119)), 0.6 * light, 0.01);
  sensor.vignetting = 0;
  sensor.gain_drift = 0.2;
  const double gain = exposure_gain(0.2, kHalfSecond_ns, 1);
  EXPECT_NEAR(light_of(expose(plane_at(2, 150), sensor, Vector3d::Zero())(80, 60)),
              gain * linear_from_srgb(150 / 255.0), 0.005);
}

TEST(ColorSensor, TheGainDriftsSlowlyWithinItsAmplitude) {
  double least = 2, most = 0, fastest = 0;
  for (std::int64_t t = 0; t < 120; ++t) {
    const double gain = exposure_gain(0.1, t * kHalfSecond_ns, 5);
    least = std::min(least, gain);
    most = std::max(most, gain);
    fastest = std::max(fastest, std::abs(exposure_gain(0.1, t * kHalfSecond_ns + 33'000'000, 5) - gain));
  }
  EXPECT_GE(least, 0.9);
  EXPECT_LE(most, 1.1);
  EXPECT_GT(most - least, 0.1);
  EXPECT_LT(fastest, 0.1 * 0.05);  // from one image to the next
  EXPECT_NE(exposure_gain(0.1, 0, 5), exposure_gain(0.1, 0, 6));
}

TEST(ColorSensor, TheSameBytesForAnyThreadsAndOthersForOtherSeeds) {
  const SimulatedScene room = make_room(4);
  const Renderer renderer(room);
  ColorSensor sensor = ideal_sensor(4);
  sensor.camera.distortion = {0.06, -0.1, 0.001, 0.002, 0};
  sensor.camera.timing.color_readout_s = 0.02;
  sensor.read_noise_grey = 1;
  sensor.shot_noise = 0.01;
  sensor.gain_drift = 0.05;
  const SE3 T_body_camera{so3_exp({-1.6, 0.2, 0.1}), room.free_space.center()};
  const auto image = [&](std::uint64_t seed, std::uint64_t frame, int threads) {
    return expose_color(renderer, sensor, straight_motion({0.3, 0.2, 0}), T_body_camera, kHalfSecond_ns, seed,
                        frame, Workers(threads))
        .data;
  };
  const auto one = image(1, 0, 1);
  EXPECT_EQ(one, image(1, 0, 2));
  EXPECT_EQ(one, image(1, 0, 3));
  EXPECT_NE(one, image(2, 0, 1));
  EXPECT_NE(one, image(1, 1, 1));
}

}  // namespace
}  // namespace fusebench
