#include "datasets/simulator/sensors/color_processing.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/sensors/srgb_encoder.hpp"

namespace fusebench::simulator::sensors {

namespace {

/// Colour filter of a pixel: 0 red, 1 green, 2 blue. Rows are GRGR... and BGBG..., as in the Kinect.
int filter_at(int u, int v) {
  if ((u + v) % 2 == 0) return 1;
  return v % 2 == 0 ? 0 : 2;
}

/// Adds a border of one pixel by mirroring at the outer pixels, which preserves the filter colour.
template <class Pixel>
Image<Pixel> with_border(const Image<Pixel>& image, const Workers& workers) {
  const auto mirrored = [](int x, int size) {
    return std::clamp(x < 0 ? -x : x >= size ? 2 * size - 2 - x : x, 0, size - 1);
  };
  Image<Pixel> result(image.width + 2, image.height + 2);
  workers.for_rows(result.height, [&](int v) {
    const int from = mirrored(v - 1, image.height);
    std::copy_n(&image(0, from), image.width, &result(1, v));
    result(0, v) = image(mirrored(-1, image.width), from);
    result(image.width + 1, v) = image(mirrored(image.width, image.width), from);
  });
  return result;
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
  workers.for_rows(raw.height, [&](int v) {
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

/// The colours at a pixel: its own, and means of the nearest pixels of the other colours. raw: with border.
std::array<float, 3> interpolated(const Image<float>& raw, int u, int v) {
  const float* above = &raw(u, v);
  const float* row = &raw(u, v + 1);
  const float* below = &raw(u, v + 2);
  const float own = row[1];
  const float beside = 0.5F * (row[0] + row[2]);
  const float upright = 0.5F * (above[1] + below[1]);
  const int filter = filter_at(u, v);
  if (filter == 1) return v % 2 == 0 ? std::array{beside, own, upright} : std::array{upright, own, beside};
  const float green = 0.5F * (beside + upright);
  const float diagonal = 0.25F * (above[0] + above[2] + below[0] + below[2]);
  return filter == 0 ? std::array{own, green, diagonal} : std::array{diagonal, green, own};
}

/// Grey levels after the tone curve; the fourth component is 0.
Image<Eigen::Array4f> encoded(const Image<float>& raw, double contrast, const Workers& workers) {
  const SrgbEncoder& encoder = SrgbEncoder::instance();
  const auto share = static_cast<float>(contrast);
  const Image<float> framed = with_border(raw, workers);
  Image<Eigen::Array4f> grey(raw.width, raw.height, Eigen::Array4f::Zero());
  workers.for_rows(raw.height, [&](int v) {
    for (int u = 0; u < raw.width; ++u) {
      const std::array<float, 3> color = interpolated(framed, u, v);
      for (std::size_t c = 0; c < 3; ++c) {
        const float x = encoder(color[c]).grey / 255.0F;
        grey(u, v)[static_cast<Eigen::Index>(c)] = 255.0F * (x + share * (x * x * (3 - 2 * x) - x));
      }
    }
  });
  return grey;
}

}  // namespace

ColorImage processed_color(const Image<Eigen::Vector3f>& light, const ColorProcessing& processing,
                           double gain, std::uint64_t key, const Workers& workers) {
  const Image<float> raw = read_out(light, processing, gain, key, workers);
  const Image<Eigen::Array4f> grey = with_border(encoded(raw, processing.contrast, workers), workers);
  ColorImage image(light.width, light.height);
  const auto share = static_cast<float>(processing.smoothing);
  workers.for_rows(image.height, [&](int v) {
    for (int u = 0; u < image.width; ++u) {
      Eigen::Array4f sum = Eigen::Array4f::Zero();
      for (int y = v; y <= v + 2; ++y) sum += grey(u, y) + grey(u + 1, y) + grey(u + 2, y);
      const Eigen::Array4f& own = grey(u + 1, v + 1);
      const Eigen::Array4f value = own + share * (sum / 9.0F - own);
      for (std::size_t c = 0; c < 3; ++c) {
        image(u, v)[c] =
            static_cast<std::uint8_t>(std::clamp(value[static_cast<Eigen::Index>(c)] + 0.5F, 0.0F, 255.0F));
      }
    }
  });
  return image;
}

}  // namespace fusebench::simulator::sensors
