#include "core/baselines/infinitam/depth_pyramid.hpp"

#include <algorithm>
#include <array>

namespace fusebench::baselines::infinitam {

namespace {

/// reduce(four pixels) returns the pixel of the next level.
template <class Reduce>
std::vector<Image<float>> pyramid(Image<float> image, int levels, const Reduce& reduce) {
  std::vector<Image<float>> result{std::move(image)};
  for (int level = 1; level < levels; ++level) {
    const Image<float>& large = result.back();
    Image<float> small(large.width / 2, large.height / 2);
    for (int y = 0; y < small.height; ++y) {
      for (int x = 0; x < small.width; ++x) {
        small(x, y) = reduce(std::array{large(2 * x, 2 * y), large(2 * x + 1, 2 * y), large(2 * x, 2 * y + 1),
                                        large(2 * x + 1, 2 * y + 1)});
      }
    }
    result.push_back(std::move(small));
  }
  return result;
}

}  // namespace

std::vector<DepthImage> depth_pyramid(const DepthImage& depth_m, int levels) {
  return pyramid(depth_m, levels, [](const std::array<float, 4>& pixels) {
    float sum = 0, measured = 0;
    for (const float pixel : pixels) {
      if (!(pixel > 0)) continue;
      sum += pixel;
      measured += 1;
    }
    return measured > 0 ? sum / measured : 0.0F;
  });
}

std::vector<Image<float>> intensity_pyramid(const GreyImage& grey, int levels) {
  Image<float> intensity(grey.width, grey.height);
  std::ranges::transform(grey.data, intensity.data.begin(),
                         [](std::uint8_t level) { return static_cast<float>(level) / 255.0F; });
  return pyramid(std::move(intensity), levels, [](const std::array<float, 4>& pixels) {
    return (pixels[0] + pixels[1] + pixels[2] + pixels[3]) / 4.0F;
  });
}

PinholeCamera camera_of_level(const PinholeCamera& camera, int level) {
  PinholeCamera small = camera;
  for (int i = 0; i < level; ++i) {
    small.width_px /= 2;
    small.height_px /= 2;
    for (double* const number : {&small.fx_px, &small.fy_px, &small.cx_px, &small.cy_px}) *number *= 0.5;
  }
  return small;
}

}  // namespace fusebench::baselines::infinitam
