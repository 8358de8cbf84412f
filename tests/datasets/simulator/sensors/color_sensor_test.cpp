#include <gtest/gtest.h>

#include <cmath>

#include "datasets/simulator/scene/room.hpp"
#include "datasets/simulator/sensors/exposure_samples.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "datasets/simulator/texture/texture.hpp"
#include "tests/datasets/simulator/simple_scenes.hpp"

namespace fusebench {

using namespace simulator::texture;
using namespace simulator::rays;
using namespace simulator::scene;
using namespace simulator::render;
using namespace simulator::sensors;
using synthetic_imu::PoseSpline;

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
  const Workers workers(threads);
  return expose_color(Renderer(scene), sensor, RayField(sensor.camera, workers),
                      straight_motion(velocity_mps), {}, kHalfSecond_ns, seed, frame, workers);
}

double light_of(const Rgb& pixel) { return linear_from_srgb(pixel[0] / 255.0); }

/// Position of the edge from black to white in a row: the equivalent number of black columns.
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
  const ColorImage image =
      expose_color(Renderer(edge_at(1)), sensor, RayField(sensor.camera, Workers(1)),
                   straight_motion(Vector3d::Zero()), T_body_camera, kHalfSecond_ns, 1, 0, Workers(1));
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
    const Workers workers(threads);
    return expose_color(renderer, sensor, RayField(sensor.camera, workers), straight_motion({0.3, 0.2, 0}),
                        T_body_camera, kHalfSecond_ns, seed, frame, workers)
        .data;
  };
  const auto one = image(1, 0, 1);
  EXPECT_EQ(one, image(1, 0, 2));
  EXPECT_EQ(one, image(1, 0, 3));
  EXPECT_NE(one, image(2, 0, 1));
  EXPECT_NE(one, image(1, 1, 1));
}

/// The image of one seed without noise, by a number of samples (0: by the motion).
ColorImage view_of(const Renderer& renderer, const PoseSpline& motion, const SE3& T_body_camera,
                   double exposure_s, int samples) {
  ColorSensor sensor = ideal_sensor(samples);
  sensor.camera.pinhole = {320, 240, 262.0, 262.0, 159.5, 119.5};
  sensor.exposure_s = exposure_s;
  return expose_color(renderer, sensor, RayField(sensor.camera, Workers(1)), motion, T_body_camera,
                      kHalfSecond_ns, 1, 0, Workers(2));
}

struct ImageDifference {
  double rms = 0;    ///< grey levels
  double mean = 0;   ///< first minus second
  double wrong = 0;  ///< share of pixels that differ by more than 40 grey levels
};
ImageDifference difference(const ColorImage& first, const ColorImage& second) {
  ImageDifference result;
  const auto count = static_cast<double>(first.data.size());
  for (std::size_t i = 0; i < first.data.size(); ++i) {
    const double by = static_cast<double>(first.data[i][1]) - second.data[i][1];
    result.rms += by * by / count;
    result.mean += by / count;
    result.wrong += std::abs(by) > 40 ? 1 / count : 0;
  }
  result.rms = std::sqrt(result.rms);
  return result;
}

/// The scene with vertices of its own for each triangle: then each triangle is a face, most pixels are at an
/// edge, and most rays are traced.
SimulatedScene without_faces(const SimulatedScene& scene) {
  SimulatedScene apart = scene;
  apart.mesh.vertices.clear();
  apart.texture_coordinates.clear();
  apart.light.clear();
  for (auto& triangle : apart.mesh.triangles) {
    for (std::uint32_t& vertex : triangle) {
      apart.mesh.vertices.push_back(scene.mesh.vertices[vertex]);
      apart.texture_coordinates.push_back(scene.texture_coordinates[vertex]);
      apart.light.push_back(scene.light[vertex]);
      vertex = static_cast<std::uint32_t>(apart.mesh.vertices.size()) - 1;
    }
  }
  return apart;
}

TEST(ColorSensor, RaysThatAreTriedWithSeenTrianglesShowWhatTracedRaysShow) {
  const SimulatedScene room = make_room(4);
  const Renderer renderer(room);
  const Renderer traced(without_faces(room));
  // 2 m/s: things at 1 and at 3 m move against each other by 5 px during the exposure.
  for (const Vector3d& velocity_mps : {Vector3d(0.02, 0, 0), Vector3d(2, 0.5, 0), Vector3d(0.3, -0.4, 1.8)}) {
    const PoseSpline motion = straight_motion(velocity_mps);
    for (const double turn_rad : {0.0, 1.3, 2.9}) {
      const SE3 T_body_camera{so3_exp({0, 0, turn_rad}) * so3_exp({-1.8, 0, 0}), room.free_space.center()};
      const ImageDifference by = difference(view_of(renderer, motion, T_body_camera, 0.015, 8),
                                            view_of(traced, motion, T_body_camera, 0.015, 8));
      EXPECT_LT(by.rms, 0.05) << velocity_mps.transpose() << ' ' << turn_rad;
      EXPECT_LT(by.wrong, 2e-5);
    }
  }
}

TEST(ColorSensor, ACardHidesTheWallAtEveryInstantOfTheExposure) {
  // A white card at 1 m before a black wall at 3 m, past which the camera moves by 7 px of the wall against
  // the card to either side of the middle of the exposure: where the wall is seen in the middle, the card is
  // later.
  SimulatedScene scene = plane_at(3, 0);
  testing::add_rectangle(scene, {-0.1F, -0.1F, 1}, {0.2F, 0, 0}, {0, 0.2F, 0}, kWhite);
  const double speed_mps = 2;
  const double exposure_s = 0.04;
  const ColorImage image = view_of(Renderer(scene), straight_motion({speed_mps, 0, 0}), {}, exposure_s, 64);
  const double blur_px = 262 * speed_mps * exposure_s;
  for (int u = 0; u < image.width; ++u) {
    // The card covers 159.5 +- 26.2 px, and blurs over blur_px: the share of the exposure it is before a
    // pixel.
    const double middle = u - 159.5;
    const double from = std::max(-0.5 * blur_px, -26.2 - middle);
    const double to = std::min(0.5 * blur_px, 26.2 - middle);
    EXPECT_NEAR(light_of(image(u, 119)), std::max(0.0, to - from) / blur_px, 0.04) << u;
  }
}

TEST(ColorSensor, SamplesByMotionShowWhatManySamplesShow) {
  const SimulatedScene room = make_room(4);
  const Renderer renderer(room);
  const SE3 T_body_camera{so3_exp({0, 0, 0.7}) * so3_exp({-1.8, 0, 0}), room.free_space.center()};
  for (const double speed_mps : {0.0, 0.1, 0.4, 1.5, 6.0}) {
    const PoseSpline motion = straight_motion({speed_mps, 0.2 * speed_mps, 0});
    const ColorImage many = view_of(renderer, motion, T_body_camera, 0.01, 128);
    const ImageDifference by_motion = difference(view_of(renderer, motion, T_body_camera, 0.01, 0), many);
    EXPECT_LT(by_motion.rms, 3) << speed_mps;
    EXPECT_NEAR(by_motion.mean, 0, 0.15) << speed_mps;
  }
}

TEST(ColorSensor, ExposuresAreSampledByTheMotionOfTheImage) {
  EXPECT_EQ(samples_of_motion(0), 8);
  EXPECT_EQ(samples_of_motion(16), 8);
  EXPECT_EQ(samples_of_motion(16.1), 9);
  EXPECT_EQ(samples_of_motion(60), 30);
  EXPECT_EQ(samples_of_motion(1000), 64);
}

TEST(ColorSensor, SamplesNeitherShiftTheImageNorChangeItsBlur) {
  for (const int samples : {8, 9, 16, 31, 64}) {
    const std::vector<Vector2d> offsets = sample_offsets_px(samples);
    Vector2d mean = Vector2d::Zero();
    Vector2d trend = Vector2d::Zero();
    double variance_px2 = 0;
    for (int i = 0; i < samples; ++i) {
      const Vector2d& offset = offsets[static_cast<std::size_t>(i)];
      mean += offset / samples;
      trend += (i + 0.5 - 0.5 * samples) / samples * offset / samples;
      variance_px2 += 0.5 * offset.squaredNorm() / samples;
    }
    EXPECT_LT(mean.norm(), 0.02) << samples;
    EXPECT_LT(trend.norm(), 0.02) << samples;
    EXPECT_NEAR(variance_px2, 1.0 / 12, 0.02) << samples << ", that of a square pixel";
  }
}

}  // namespace
}  // namespace fusebench
