// Stamps, automatic exposure, the mosaic of filters and the fixed errors of depth, against what they state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/simulator/sensors/auto_exposure.hpp"
#include "datasets/simulator/sensors/color_processing.hpp"
#include "datasets/simulator/sensors/depth_errors.hpp"
#include "datasets/simulator/sensors/frame_timing.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "tests/datasets/simulator/simple_scenes.hpp"

namespace fusebench {

using namespace simulator::scene;
using namespace simulator::render;
using namespace simulator::sensors;

namespace {

constexpr std::int64_t kSpacing_ns = 33'333'000;

std::vector<std::int64_t> many_frames(std::size_t count) {
  std::vector<std::int64_t> capture_ns;
  for (std::size_t k = 0; k < count; ++k)
    capture_ns.push_back(1'000'000'000 + static_cast<std::int64_t>(k) * kSpacing_ns);
  return capture_ns;
}

TEST(FrameTiming, JitterAndGapsAreAsStated) {
  constexpr std::size_t kCount = 20000;
  const auto capture_ns = many_frames(kCount);
  const ImageStamps images = stamped(capture_ns, {0.001, 0.01}, 1000, 1, ImageStream::color);
  double sum = 0, squares = 0;
  for (std::size_t k = 0; k < kCount; ++k) {
    const double late_s = 1e-9 * static_cast<double>(images.stamp_ns[k] - capture_ns[k]);
    sum += late_s;
    squares += late_s * late_s;
    if (k > 0) {
      EXPECT_GT(images.stamp_ns[k], images.stamp_ns[k - 1]);
    }
  }
  EXPECT_NEAR(sum / kCount, 0, 4e-5);
  EXPECT_NEAR(std::sqrt(squares / kCount), 0.001, 3e-5);
  const auto dropped = static_cast<double>(std::ranges::count(images.dropped, true));
  EXPECT_NEAR(dropped / kCount, 0.01, 0.003);
  EXPECT_FALSE(images.dropped[0]);
}

TEST(FrameTiming, ColorAndDepthErrIndependentlyAndSeedsDiffer) {
  const auto capture_ns = many_frames(2000);
  const StampErrors errors{0.001, 0.1};
  const ImageStamps color = stamped(capture_ns, errors, 1000, 1, ImageStream::color);
  const ImageStamps depth = stamped(capture_ns, errors, 1000, 1, ImageStream::depth);
  double product = 0;
  for (std::size_t k = 0; k < capture_ns.size(); ++k) {
    product += 1e-18 * static_cast<double>(color.stamp_ns[k] - capture_ns[k]) *
               static_cast<double>(depth.stamp_ns[k] - capture_ns[k]);
  }
  EXPECT_LT(std::abs(product / 2000), 0.1 * 0.001 * 0.001);
  EXPECT_NE(color.dropped, depth.dropped);
  EXPECT_NE(color.stamp_ns, stamped(capture_ns, errors, 1000, 2, ImageStream::color).stamp_ns);
}

TEST(FrameTiming, WithoutErrorsStampsAreTheCaptures) {
  const auto capture_ns = many_frames(50);
  const ImageStamps images = stamped(capture_ns, {}, 1000, 1, ImageStream::depth);
  EXPECT_EQ(images.stamp_ns, capture_ns);
  EXPECT_EQ(std::ranges::count(images.dropped, true), 0);
}

/// A scene that is of one light for a second, then of another for two.
std::vector<FrameExposure> step_from(float first, float then) {
  std::vector<std::vector<float>> light;
  for (int k = 0; k < 90; ++k) light.push_back(std::vector<float>(100, k < 30 ? first : then));
  ExposureControl control;
  control.on = true;
  return controlled_exposures(control, light);
}

TEST(AutoExposure, ReachesItsTargetAndStaysWithinItsLimits) {
  const ExposureControl control;
  for (const float light : {0.05F, 0.12F, 0.3F}) {
    const auto exposures = step_from(light, light);
    for (const FrameExposure& e : exposures) {
      EXPECT_GE(e.exposure_s, 0.005);
      EXPECT_LE(e.exposure_s, 0.025);
      const std::vector<float> pixel = {light};
      EXPECT_NEAR(mean_grey(pixel, e.gain * e.exposure_s / control.unit_exposure_s), control.target_grey, 2);
    }
  }
}

TEST(AutoExposure, FollowsBrightnessLateAndWithoutSwinging) {
  const auto exposures = step_from(0.3F, 0.1F);
  const auto factor = [&](std::size_t k) { return exposures[k].exposure_s * exposures[k].gain; };
  EXPECT_NEAR(factor(31), factor(29), 1e-6);  // it has not seen the dark yet
  EXPECT_GT(factor(34), 1.05 * factor(29));
  for (std::size_t k = 31; k < 90; ++k) EXPECT_GE(factor(k), 0.97 * factor(k - 1)) << k;
  EXPECT_NEAR(factor(89) / factor(29), 3, 0.15);  // light and exposure are inverse
}

TEST(AutoExposure, ExposesLongBeforeItAmplifiesAndGivesUpInTheDark) {
  const auto dim = step_from(0.02F, 0.02F);
  EXPECT_DOUBLE_EQ(dim.back().exposure_s, 0.025);
  EXPECT_GT(dim.back().gain, 2);
  EXPECT_DOUBLE_EQ(step_from(0.3F, 0.3F).back().gain, 1);
  EXPECT_DOUBLE_EQ(step_from(0.0F, 0.0F).back().gain, 8);
  EXPECT_DOUBLE_EQ(step_from(1.0F, 50.0F).back().exposure_s, 0.005);
}

Image<Eigen::Vector3f> flat_light(const Eigen::Vector3f& light) {
  return Image<Eigen::Vector3f>(160, 120, light);
}

ColorProcessing noisy_mosaic() {
  ColorProcessing processing;
  processing.mosaic = true;
  processing.shot_noise = {0.02, 0.02, 0.02};
  return processing;
}

TEST(ColorProcessing, AMosaicKeepsEvenColors) {
  ColorProcessing processing = noisy_mosaic();
  processing.shot_noise = {};
  const ColorImage image = processed_color(flat_light({0.1F, 0.3F, 0.7F}), processing, 1, 1, Workers(1));
  for (const Rgb& pixel : image.data) EXPECT_EQ(pixel, image.data.front());
  EXPECT_NEAR(image(5, 5)[0], 255 * simulator::texture::srgb_from_linear(0.1), 0.6);
  EXPECT_NEAR(image(5, 5)[2], 255 * simulator::texture::srgb_from_linear(0.7), 0.6);
}

/// Statistics of green over an even image: variance, and correlation of neighbouring pixels.
std::array<double, 2> noise_of(const ColorImage& image) {
  double mean = 0, squares = 0, product = 0;
  for (const Rgb& pixel : image.data) mean += pixel[1] / static_cast<double>(image.data.size());
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u + 1 < image.width; ++u) {
      squares += (image(u, v)[1] - mean) * (image(u, v)[1] - mean);
      product += (image(u, v)[1] - mean) * (image(u + 1, v)[1] - mean);
    }
  }
  return {squares / static_cast<double>(image.data.size()), product / squares};
}

TEST(ColorProcessing, NoiseIsSharedByNeighboursAndGrowsWithGain) {
  const auto noise = [](double gain) {
    return noise_of(processed_color(flat_light({0.2F, 0.2F, 0.2F}), noisy_mosaic(), gain, 1, Workers(1)));
  };
  // Half of the greens are measured, half are means of four: a quarter of a pixel is shared, of 5/8.
  EXPECT_NEAR(noise(1)[1], 0.4, 0.05);
  EXPECT_NEAR(noise(4)[0] / noise(1)[0], 4, 0.4);
}

TEST(ColorProcessing, TheSameBytesForAnyThreadsAndOthersForOtherKeys) {
  const auto light = flat_light({0.2F, 0.5F, 0.4F});
  const auto one = processed_color(light, noisy_mosaic(), 2, 7, Workers(1)).data;
  EXPECT_EQ(one, processed_color(light, noisy_mosaic(), 2, 7, Workers(4)).data);
  EXPECT_NE(one, processed_color(light, noisy_mosaic(), 2, 8, Workers(1)).data);
}

// Pixels of kinect_like(), in units of the sensor's 640 columns.
constexpr double kFocalBaseline_px_m = 520 * 0.075;

DepthSensor kinect_like() {
  DepthSensor sensor;
  sensor.camera = {320, 240, 260.0, 260.0, 159.5, 119.5};
  sensor.units_per_metre = 5000;
  return sensor;
}

Image<std::uint16_t> seen(const SimulatedScene& scene, const DepthSensor& sensor, std::uint64_t seed = 1,
                          std::uint64_t frame = 0, int threads = 1) {
  return sense_depth(Renderer(scene), sensor, testing::straight_motion(Vector3d::Zero()), {},
                     testing::kHalfSecond_ns, seed, frame, Workers(threads));
}

double share_measured(const Image<std::uint16_t>& depth) {
  return 1 - static_cast<double>(std::ranges::count(depth.data, 0)) / static_cast<double>(depth.data.size());
}

TEST(DepthErrors, ScaleIsAsStatedAndThePatternBelongsToTheDevice) {
  DepthSensor sensor = kinect_like();
  sensor.errors.scale = 0.01;
  EXPECT_NEAR(seen(testing::plane_at(2, 128), sensor)(160, 120) / 5000.0, 2.02, 1e-3);
  sensor.errors = {};
  sensor.errors.smooth_px = 0.2;
  sensor.errors.pattern_px = 0.05;
  const auto first = seen(testing::plane_at(2, 128), sensor, 1, 0);
  EXPECT_EQ(first.data, seen(testing::plane_at(2, 128), sensor, 1, 7, 4).data);  // of any image and threads
  EXPECT_NE(first.data, seen(testing::plane_at(2, 128), sensor, 2, 0).data);
  double squares = 0;
  for (const std::uint16_t raw : first.data) {
    const double error_px = kFocalBaseline_px_m / (raw / 5000.0) - kFocalBaseline_px_m / 2;
    squares += error_px * error_px / static_cast<double>(first.data.size());
  }
  EXPECT_NEAR(std::sqrt(squares), std::hypot(0.2, 0.05), 0.08);  // a dozen smooth cells only
}

/// A plane 2 m away that is turned about the vertical.
SimulatedScene turned_plane(double turn_rad, std::uint8_t grey) {
  SimulatedScene scene;
  const Eigen::Vector3f along =
      Eigen::Vector3d(40 * std::cos(turn_rad), 0, 40 * std::sin(turn_rad)).cast<float>();
  testing::add_rectangle(scene, Eigen::Vector3f(0, -20, 2) - 0.5F * along, along, {0, 40, 0}, grey);
  return scene;
}

TEST(DepthErrors, NothingIsMeasuredAtGrazingAnglesNorOnDarkSurfaces) {
  DepthSensor sensor = kinect_like();
  sensor.errors.lost_light = true;
  const double steep = 80 * std::numbers::pi / 180;
  const auto middle = [&](const SimulatedScene& scene) { return seen(scene, sensor)(160, 120); };
  EXPECT_GT(middle(turned_plane(0, 200)), 0);
  EXPECT_GT(middle(turned_plane(0.9, 200)), 0);
  EXPECT_EQ(middle(turned_plane(steep, 200)), 0);
  EXPECT_GT(share_measured(seen(testing::plane_at(2, 128), sensor)), 0.99);
  EXPECT_LT(share_measured(seen(testing::plane_at(2.5F, 20), sensor)), 0.05);  // black
  EXPECT_GT(share_measured(seen(testing::plane_at(0.5F, 40), sensor)), 0.95);  // near enough again
  sensor.errors = {};
  EXPECT_GT(middle(turned_plane(steep, 200)), 0);
}

TEST(DepthErrors, RegisteredDepthHasMargins) {
  DepthSensor sensor = kinect_like();
  sensor.errors.border = true;
  const auto depth = seen(testing::plane_at(2, 128), sensor);
  EXPECT_EQ(depth(2, 120), 0);
  EXPECT_EQ(depth(310, 120), 0);
  EXPECT_EQ(depth(160, 10), 0);
  EXPECT_NEAR(share_measured(depth), 0.84, 0.02);
}

TEST(Kinect, NoiseOfDisparityIsThatOfRealPlanes) {
  DepthSensor sensor = kinect_like();
  sensor.noise = DepthNoise::kinect;
  for (const float depth_m : {0.8F, 1.2F, 2.1F}) {
    const auto depth = seen(testing::plane_at(depth_m, 128), sensor);
    double squares = 0, count = 0;
    for (int v = 20; v < 220; ++v) {
      for (int u = 60; u < 300; ++u) {
        if (depth(u, v) == 0) continue;
        const double error_px = kFocalBaseline_px_m / (depth(u, v) / 5000.0) - kFocalBaseline_px_m / depth_m;
        squares += error_px * error_px;
        ++count;
      }
    }
    EXPECT_GT(count, 0.95 * 200 * 240);
    EXPECT_NEAR(std::sqrt(squares / count), 0.06, 0.025) << depth_m;
  }
}

}  // namespace
}  // namespace fusebench
