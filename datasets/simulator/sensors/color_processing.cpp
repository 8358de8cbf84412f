#include "datasets/simulator/sensors/color_processing.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/sensors/srgb_encoder.hpp"

namespace fusebench::simulator::sensors {

namespace {

constexpr std::size_t kRowsPerChunk = 16;

template <class Fill>
void fill_rows(const Workers& workers, int rows, const Fill& fill) {
  workers.for_chunks(static_cast<std::size_t>(rows), kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    for (auto row = static_cast<int>(begin); row < static_cast<int>(end); ++row) fill(row);
  });
}

/// The filter before a pixel: 0 red, 1 green, 2 blue. Rows are GRGR... and BGBG..., as in the Kinect.
int filter_at(int u, int v) {
  if ((u + v) % 2 == 0) return 1;
  return v % 2 == 0 ? 0 : 2;
}

/// Mirrors at the border, which keeps the colour of the filter.
int mirrored(int x, int size) {
  if (x < 0) x = -x;
  if (x >= size) x = 2 * size - 2 - x;
  return std::clamp(x, 0, size - 1);
}

/// Digital numbers of the pixels, 0 to 1.
Image<float> read_out(const Image<Eigen::Vector3f>& light, const ColorProcessing& processing, double gain,
                      std::uint64_t key, const Workers& workers) {
  Image<float> raw(light.width, light.height);
  const random::NormalTable& normal = random::NormalTable::instance();
  const auto read2 = static_cast<float>(processing.read_noise * processing.read_noise * gain * gain);
  std::array<float, 3> shot2{};
  for (std::size_t c = 0; c < 3; ++c)
    shot2[c] = static_cast<float>(processing.shot_noise[c] * processing.shot_noise[c] * gain);
  fill_rows(workers, raw.height, [&](int v) {
    for (int u = 0; u < raw.width; ++u) {
      const int c = filter_at(u, v);
      const float value = std::max(0.0F, light(u, v)[c]);
      const float sigma = std::sqrt(read2 + shot2[static_cast<std::size_t>(c)] * value);
      const float noise = normal(random::mix_key(key, raw.index(u, v)));
      raw(u, v) = std::clamp(value + sigma * noise, 0.0F, 1.0F);
    }
  });
  return raw;
}

/// The colours at a pixel: its own, and means of the nearest pixels behind the other filters.
Eigen::Vector3f interpolated(const Image<float>& raw, int u, int v) {
  const auto at = [&](int du, int dv) {
    return raw(mirrored(u + du, raw.width), mirrored(v + dv, raw.height));
  };
  const float beside = 0.5F * (at(-1, 0) + at(1, 0));
  const float above = 0.5F * (at(0, -1) + at(0, 1));
  const float own = raw(u, v);
  Eigen::Vector3f color;
  if (filter_at(u, v) == 1) {
    const bool red_row = v % 2 == 0;
    color = {red_row ? beside : above, own, red_row ? above : beside};
    return color;
  }
  const float diagonal = 0.25F * (at(-1, -1) + at(1, -1) + at(-1, 1) + at(1, 1));
  const bool red = filter_at(u, v) == 0;
  color = {red ? own : diagonal, 0.5F * (beside + above), red ? diagonal : own};
  return color;
}

/// Grey levels after the tone curve.
Image<Eigen::Vector3f> encoded(const Image<float>& raw, double contrast, const Workers& workers) {
  const SrgbEncoder& encoder = SrgbEncoder::instance();
  const auto share = static_cast<float>(contrast);
  Image<Eigen::Vector3f> grey(raw.width, raw.height);
  fill_rows(workers, raw.height, [&](int v) {
    for (int u = 0; u < raw.width; ++u) {
      const Eigen::Vector3f color = interpolated(raw, u, v);
      for (Eigen::Index c = 0; c < 3; ++c) {
        const float x = encoder(color[c]).grey / 255.0F;
        grey(u, v)[c] = 255.0F * (x + share * (x * x * (3 - 2 * x) - x));
      }
    }
  });
  return grey;
}

}  // namespace

ColorImage processed_color(const Image<Eigen::Vector3f>& light, const ColorProcessing& processing,
                           double gain, std::uint64_t key, const Workers& workers) {
  const Image<float> raw = read_out(light, processing, gain, key, workers);
  const Image<Eigen::Vector3f> grey = encoded(raw, processing.contrast, workers);
  ColorImage image(light.width, light.height);
  const auto share = static_cast<float>(processing.smoothing);
  fill_rows(workers, image.height, [&](int v) {
    for (int u = 0; u < image.width; ++u) {
      Eigen::Vector3f mean = Eigen::Vector3f::Zero();
      for (int y = v - 1; y <= v + 1; ++y) {
        for (int x = u - 1; x <= u + 1; ++x)
          mean += grey(mirrored(x, grey.width), mirrored(y, grey.height)) / 9.0F;
      }
      const Eigen::Vector3f value = grey(u, v) + share * (mean - grey(u, v));
      for (std::size_t c = 0; c < 3; ++c) {
        image(u, v)[c] =
            static_cast<std::uint8_t>(std::clamp(value[static_cast<Eigen::Index>(c)] + 0.5F, 0.0F, 255.0F));
      }
    }
  });
  return image;
}

}  // namespace fusebench::simulator::sensors
