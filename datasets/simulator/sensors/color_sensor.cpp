#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "datasets/simulator/sensors/srgb_encoder.hpp"

namespace fusebench::simulator::sensors {

namespace {

constexpr std::size_t kRowsPerChunk = 8;

// Keys of independent random streams of one seed.
constexpr std::uint64_t kPixelNoise = 0xC0;
constexpr std::uint64_t kGainPhase = 0xC1;

/// Places within the pixel for the samples of an exposure: a low-discrepancy sequence (Roberts' R2), from
/// which mean and trend over time are taken out, since they would shift the image and change the length of
/// its blur.
std::vector<Vector2d> sample_offsets(int samples) {
  constexpr double kPlastic = 1.32471795724474602596;
  std::vector<Vector2d> offsets;
  Vector2d mean = Vector2d::Zero();
  Vector2d trend = Vector2d::Zero();
  double squares = 0;
  const auto time_of = [&](int i) { return i + 0.5 - 0.5 * samples; };
  for (int i = 0; i < samples; ++i) {
    const Vector2d place(0.5 + i / kPlastic, 0.5 + i / (kPlastic * kPlastic));
    offsets.emplace_back(place.array() - place.array().floor());
    mean += offsets.back() / samples;
    trend += time_of(i) * offsets.back();
    squares += time_of(i) * time_of(i);
  }
  if (squares > 0) trend /= squares;
  for (int i = 0; i < samples; ++i) {
    const Vector2d centred = offsets[static_cast<std::size_t>(i)] - mean - time_of(i) * trend;
    offsets[static_cast<std::size_t>(i)] = centred.cwiseMax(-0.5).cwiseMin(0.5);
  }
  return offsets;
}

/// Parameters that are constant within an image.
struct Exposure {
  const render::Renderer& renderer;
  const ColorSensor& sensor;
  const synthetic_imu::PoseSpline& motion;
  const SE3& T_body_camera;
  std::int64_t capture_ns;
  std::uint64_t noise_key;
  float gain;
  rays::RayField rays;
  std::vector<Vector2d> offsets;
  SrgbEncoder encoder;
  const MovingObject* before;

  [[nodiscard]] std::int64_t instant_ns(int row, std::size_t sample) const {
    const double middle = (static_cast<double>(sample) + 0.5) / static_cast<double>(offsets.size()) - 0.5;
    const auto after_ns = static_cast<std::int64_t>(std::llround(1e9 * sensor.exposure_s * middle));
    const std::int64_t row_ns =
        row_time_ns(capture_ns, sensor.camera.timing.color_readout_s, row, sensor.camera.pinhole.height_px);
    return row_ns + after_ns;
  }

  [[nodiscard]] SE3 T_world_camera(int row, std::size_t sample) const {
    return motion.evaluate(instant_ns(row, sample)).T_world_body * T_body_camera;
  }

  /// The row's light, averaged over the exposure.
  void integrate(int row, const std::vector<SE3>& poses, std::span<Eigen::Vector3f> light) const {
    const auto count = static_cast<float>(offsets.size());
    for (std::size_t s = 0; s < offsets.size(); ++s) {
      std::optional<render::Foreground> thing;
      if (before != nullptr)
        thing.emplace(render::Foreground{before->surface, before->T_object_camera(instant_ns(row, s))});
      renderer.add_light_of_row(rays, row, poses[s], offsets[s], 1.0F / std::sqrt(count), 1.0F / count, light,
                                thing ? &*thing : nullptr, seconds_between(0, instant_ns(row, s)));
    }
  }

  /// Vignetting and gain of one row.
  void transmit(int row, const ColorImage& image, std::span<Eigen::Vector3f> light) const {
    const double centre_x = 0.5 * (image.width - 1);
    const double centre_y = 0.5 * (image.height - 1);
    const double corner2 = centre_x * centre_x + centre_y * centre_y;
    const double y2 = (row - centre_y) * (row - centre_y);
    for (int u = 0; u < image.width; ++u) {
      const double r2 = ((u - centre_x) * (u - centre_x) + y2) / corner2;
      light[static_cast<std::size_t>(u)] *= gain * static_cast<float>(1.0 - sensor.vignetting * r2);
    }
  }

  /// Noise and encoding of one row.
  void develop(int row, std::span<const Eigen::Vector3f> light, ColorImage& image) const {
    const bool noisy = sensor.read_noise_grey > 0 || sensor.shot_noise > 0;
    const auto read2 = static_cast<float>(sensor.read_noise_grey * sensor.read_noise_grey);
    const auto shot2 = static_cast<float>(sensor.shot_noise * sensor.shot_noise);
    const random::NormalTable& normal = random::NormalTable::instance();
    for (int u = 0; u < image.width; ++u) {
      std::array<float, 3> draws{};
      if (noisy) draws = normal.triple(random::mix_key(noise_key, image.index(u, row)));
      for (std::size_t c = 0; c < 3; ++c) {
        const float value = light[static_cast<std::size_t>(u)][static_cast<Eigen::Index>(c)];
        const SrgbEncoder::Encoded at = encoder(value);
        // Shot noise is that of the light; its slope carries it to grey levels, where one draw serves both.
        const float variance = read2 + shot2 * std::clamp(value, 0.0F, 1.0F) * at.slope * at.slope;
        const float grey = at.grey + std::sqrt(variance) * draws[c];
        image(u, row)[c] = static_cast<std::uint8_t>(std::clamp(grey + 0.5F, 0.0F, 255.0F));
      }
    }
  }
};

}  // namespace

std::int64_t row_time_ns(std::int64_t capture_ns, double readout_s, int row, int height_px) {
  if (readout_s == 0 || height_px < 2) return capture_ns;
  const double fraction = static_cast<double>(row) / (height_px - 1) - 0.5;
  return capture_ns + static_cast<std::int64_t>(std::llround(1e9 * readout_s * fraction));
}

double exposure_gain(double drift, std::int64_t capture_ns, std::uint64_t seed) {
  if (drift == 0) return 1;
  constexpr std::array<std::array<double, 2>, 3> kPeriodAndShare = {{{3.1, 0.25}, {7.3, 0.35}, {17.0, 0.4}}};
  const double t = seconds_between(0, capture_ns);
  double sum = 0;
  for (std::size_t i = 0; i < kPeriodAndShare.size(); ++i) {
    const auto [period_s, share] = kPeriodAndShare[i];
    const double phase = random::unit_interval(random::mix_key(random::mix_key(seed, kGainPhase), i));
    sum += share * std::sin(2 * std::numbers::pi * (t / period_s + phase));
  }
  return 1 + drift * sum;
}

ColorImage expose_color(const render::Renderer& renderer, const ColorSensor& sensor,
                        const synthetic_imu::PoseSpline& motion, const SE3& T_body_camera,
                        std::int64_t capture_ns, std::uint64_t seed, std::uint64_t frame,
                        const Workers& workers, const MovingObject* before) {
  const PinholeCamera& camera = sensor.camera.pinhole;
  check(camera.width_px > 0 && camera.height_px > 0, "a simulated camera has a size");
  check(sensor.blur_samples >= 1, "an exposure has at least one sample");
  const Exposure exposure{
      .renderer = renderer,
      .sensor = sensor,
      .motion = motion,
      .T_body_camera = T_body_camera,
      .capture_ns = capture_ns,
      .noise_key = random::mix_key(random::mix_key(seed, kPixelNoise), frame),
      .gain = static_cast<float>(sensor.gain * exposure_gain(sensor.gain_drift, capture_ns, seed)),
      .rays = rays::RayField(sensor.camera, workers),
      .offsets = sample_offsets(sensor.blur_samples),
      .encoder = {},
      .before = before};
  ColorImage image(camera.width_px, camera.height_px);
  const auto rows = static_cast<std::size_t>(camera.height_px);
  const bool rolling = sensor.camera.timing.color_readout_s != 0;
  const bool mosaic = sensor.processing.mosaic;  // neighbours are needed: the whole image, then its colours
  Image<Eigen::Vector3f> whole(mosaic ? camera.width_px : 0, mosaic ? camera.height_px : 0);
  workers.for_chunks(rows, kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    std::vector<SE3> poses(exposure.offsets.size());
    std::vector<Eigen::Vector3f> light(static_cast<std::size_t>(camera.width_px));
    for (auto row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
      if (rolling || row == static_cast<int>(begin)) {
        for (std::size_t s = 0; s < poses.size(); ++s) poses[s] = exposure.T_world_camera(row, s);
      }
      std::ranges::fill(light, Eigen::Vector3f::Zero());
      if (!sensor.covered) exposure.integrate(row, poses, light);
      exposure.transmit(row, image, light);
      if (mosaic) {
        std::ranges::copy(light, &whole(0, row));
      } else {
        exposure.develop(row, light, image);
      }
    }
  });
  if (mosaic)
    return processed_color(whole, sensor.processing, sensor.amplifier_gain, exposure.noise_key, workers);
  return image;
}

}  // namespace fusebench::simulator::sensors
