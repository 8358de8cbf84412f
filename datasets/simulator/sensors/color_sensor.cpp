#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/sensors/exposure_samples.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "datasets/simulator/sensors/srgb_encoder.hpp"

namespace fusebench::simulator::sensors {

namespace {

constexpr std::size_t kRowsPerChunk = 8;

// Keys of independent random streams of one seed.
constexpr std::uint64_t kPixelNoise = 0xC0;
constexpr std::uint64_t kGainPhase = 0xC1;

/// Parameters that are constant within an image.
struct Exposure {
  const render::Renderer& renderer;
  const ColorSensor& sensor;
  const rays::RayField& rays;
  const synthetic_imu::PoseSpline& motion;
  const SE3& T_body_camera;
  std::int64_t capture_ns;
  std::uint64_t noise_key;
  float gain;
  const MovingObject* before;

  /// Instant of a row after a share of the exposure.
  [[nodiscard]] std::int64_t instant_ns(int row, double share) const {
    const auto after_ns = static_cast<std::int64_t>(std::llround(1e9 * sensor.exposure_s * (share - 0.5)));
    const std::int64_t row_ns =
        row_time_ns(capture_ns, sensor.camera.timing.color_readout_s, row, sensor.camera.pinhole.height_px);
    return row_ns + after_ns;
  }

  /// Poses of the rows after a share of the exposure.
  [[nodiscard]] render::RowPoses poses(double share) const {
    const bool rolls = sensor.camera.timing.color_readout_s != 0;
    const int rows = rolls ? sensor.camera.pinhole.height_px : 1;
    render::RowPoses poses;
    for (int row = 0; row < rows; ++row) {
      const SE3 T_world_body = motion.evaluate(instant_ns(row, share)).T_world_body;
      poses.T_world_camera.push_back(T_world_body * T_body_camera);
    }
    return poses;
  }

  /// Image motion of visible points during the exposure.
  [[nodiscard]] double motion_px(const render::VisibleTriangles& visible) const {
    return render::longest_image_motion_px(visible, rays, poses(0), poses(1));
  }

  /// Number of samples: blur_samples, or by the image motion if it is 0.
  [[nodiscard]] int samples(double motion_px) const {
    return sensor.blur_samples > 0 ? sensor.blur_samples : samples_of_motion(motion_px);
  }

  /// One sample of all rows.
  struct Instant {
    double share;  ///< of the exposure
    render::RowPoses poses;
    Vector2d offset_px;
  };
  [[nodiscard]] std::vector<Instant> instants(int count) const {
    std::vector<Instant> instants;
    for (const Vector2d& offset_px : sample_offsets_px(count)) {
      const double share = (static_cast<double>(instants.size()) + 0.5) / count;
      instants.push_back({share, poses(share), offset_px});
    }
    return instants;
  }

  /// Averages the light of a row over the exposure.
  void integrate(int row, const std::vector<Instant>& instants, const render::VisibleTriangles& visible,
                 std::span<Eigen::Array4f> light) const {
    std::vector<render::Foreground> things;
    std::vector<render::RowSample> samples;
    things.reserve(instants.size());
    const float share_of_each = 1.0F / static_cast<float>(instants.size());
    for (const Instant& at : instants) {
      const std::int64_t time_ns = instant_ns(row, at.share);
      if (before != nullptr) things.push_back({before->surface, before->T_object_camera(time_ns)});
      samples.push_back({.row = row,
                         .T_world_camera = at.poses.of_row(row),
                         .offset_px = at.offset_px,
                         .footprint_px = std::sqrt(share_of_each),
                         .weight = share_of_each,
                         .time_s = seconds_between(0, time_ns),
                         .nearby = &visible,
                         .foreground = before != nullptr ? &things.back() : nullptr});
    }
    renderer.add_light_of_row(rays, samples, light);
  }

  /// Applies vignetting and gain to a row.
  void transmit(int row, const ColorImage& image, std::span<Eigen::Array4f> light) const {
    const double centre_x = 0.5 * (image.width - 1);
    const double centre_y = 0.5 * (image.height - 1);
    const double corner2 = centre_x * centre_x + centre_y * centre_y;
    const double y2 = (row - centre_y) * (row - centre_y);
    for (int u = 0; u < image.width; ++u) {
      const double r2 = ((u - centre_x) * (u - centre_x) + y2) / corner2;
      light[static_cast<std::size_t>(u)] *= gain * static_cast<float>(1.0 - sensor.vignetting * r2);
    }
  }

  /// Applies noise and encoding to a row.
  void develop(int row, std::span<const Eigen::Array4f> light, ColorImage& image) const {
    const bool noisy = sensor.read_noise_grey > 0 || sensor.shot_noise > 0;
    const auto read2 = static_cast<float>(sensor.read_noise_grey * sensor.read_noise_grey);
    const auto shot2 = static_cast<float>(sensor.shot_noise * sensor.shot_noise);
    const random::NormalTable& normal = random::NormalTable::instance();
    const SrgbEncoder& encoder = SrgbEncoder::instance();
    for (int u = 0; u < image.width; ++u) {
      std::array<float, 3> draws{};
      if (noisy) draws = normal.triple(random::mix_key(noise_key, image.index(u, row)));
      for (std::size_t c = 0; c < 3; ++c) {
        const float value = light[static_cast<std::size_t>(u)][static_cast<Eigen::Index>(c)];
        const SrgbEncoder::Encoded at = encoder(value);
        // The shot noise of the light is scaled to grey levels by the slope of the encoding, so one random
        // number is sufficient for both noises.
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
                        const rays::RayField& rays, const synthetic_imu::PoseSpline& motion,
                        const SE3& T_body_camera, std::int64_t capture_ns, std::uint64_t seed,
                        std::uint64_t frame, const Workers& workers, const MovingObject* before) {
  const PinholeCamera& camera = sensor.camera.pinhole;
  check(camera.width_px > 0 && camera.height_px > 0, "a simulated camera has a size");
  check(sensor.blur_samples >= 0, "an exposure has a number of samples");
  const Exposure exposure{
      .renderer = renderer,
      .sensor = sensor,
      .rays = rays,
      .motion = motion,
      .T_body_camera = T_body_camera,
      .capture_ns = capture_ns,
      .noise_key = random::mix_key(random::mix_key(seed, kPixelNoise), frame),
      .gain = static_cast<float>(sensor.gain * exposure_gain(sensor.gain_drift, capture_ns, seed)),
      .before = before};
  render::VisibleTriangles visible;
  std::vector<Exposure::Instant> instants;
  if (!sensor.covered) {
    visible = renderer.visible_triangles(rays, exposure.poses(0.5), workers);
    const double motion_px = exposure.motion_px(visible);
    instants = exposure.instants(exposure.samples(motion_px));
    // From the middle of the exposure to its ends, plus half a pixel.
    const double distance_px = std::min(0.5 * motion_px + 1, static_cast<double>(camera.width_px));
    render::find_nearest_around(static_cast<int>(std::ceil(distance_px)), visible);
  }
  ColorImage image(camera.width_px, camera.height_px);
  const bool mosaic = sensor.processing.mosaic;  // demosaicing uses neighbours, so it runs on the whole image
  Image<Eigen::Vector3f> whole(mosaic ? camera.width_px : 0, mosaic ? camera.height_px : 0);
  workers.for_chunks(static_cast<std::size_t>(camera.height_px), kRowsPerChunk,
                     [&](std::size_t begin, std::size_t end) {
                       std::vector<Eigen::Array4f> light(static_cast<std::size_t>(camera.width_px));
                       for (auto row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
                         std::ranges::fill(light, Eigen::Array4f::Zero());
                         exposure.integrate(row, instants, visible, light);
                         exposure.transmit(row, image, light);
                         if (!mosaic) {
                           exposure.develop(row, light, image);
                           continue;
                         }
                         std::ranges::transform(light, &whole(0, row), [](const Eigen::Array4f& pixel) {
                           return Eigen::Vector3f(pixel.head<3>().matrix());
                         });
                       }
                     });
  if (mosaic)
    return processed_color(whole, sensor.processing, sensor.amplifier_gain, exposure.noise_key, workers);
  return image;
}

}  // namespace fusebench::simulator::sensors
