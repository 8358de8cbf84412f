// Depth by active stereo, for the RealSense R200 and ZR300 (two infrared cameras, a projector of random
// dots).
//
// From Intel's documents: baseline 70 mm and a search over 63 disparities, so nothing nearer than f B / 63 is
// measured (librealsense v1.12.1, doc/camera_specs.md); matching over a 7 x 7 window, and errors of disparity
// that are about constant, so that depth noise grows with z^2 (Keselman et al., "Intel RealSense Stereoscopic
// Depth Cameras", CVPR workshops 2017); raw depth in units of 1 mm (the format, so
// DepthSensor::units_per_metre).
//
// Pixels are the sensor's (native_pixels.hpp). Assumptions of ours: a standard deviation of 0.09 px for the
// disparity, shared by neighbours over about half the matching window (the field is interpolated from one
// value each 4 px); disparities in steps of 1/32 px; beyond 4 m, where the dots fade, noise grows and
// measurements fail more and more until nothing is left at 6 m; windows that see a jump of disparity of more
// than 1.5 px give nothing on the far side of it, and those on surfaces at more than 80 degrees give nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/random/smooth_noise.hpp"
#include "datasets/simulator/sensors/depth_noise.hpp"

namespace fusebench::simulator::sensors {

namespace {

struct StereoSensor {
  double baseline_m;
  float max_disparity_px;
  float noise_px;
  float steps_per_pixel;
  float fade_begin_m;
  float fade_end_m;
};
constexpr StereoSensor kZr300{0.07, 63, 0.09F, 32, 4, 6};
// Nothing nearer than 0.45 m; steps of 1/8 px (Khoshelham & Elberink, Sensors 2012). The noise is what
// freiburg1_rpy and freiburg1_xyz show: planes of 9 x 9 pixels leave 0.055 px between 0.4 and 1.6 m and 0.047
// px beyond, of which the steps make 0.036 px.
constexpr StereoSensor kKinect{0.075, 87, 0.045F, 8, 5, 8};
constexpr int kNoiseSpacing_px = 4;
constexpr int kHalfWindow = 2;  // the outer ring of the 7 x 7 window has little weight
constexpr float kJump_px = 1.5F;
constexpr float kOcclusion_px = 1;
constexpr float kMinCosine = 0.1736F;  // 80 degrees

constexpr std::uint64_t kFieldKey = 3;
constexpr std::uint64_t kFadeKey = 4;

/// Occlusion in the right image: 1 if a nearer surface hides the point of a pixel of the left image row, or
/// if the point is outside the right image. native_px: sensor pixels per image pixel.
std::vector<std::uint8_t> occluded_in_right(std::span<const float> disparity_px, float native_px) {
  const std::size_t width = disparity_px.size();
  std::vector<float> nearest(width, 0.0F);  // by column of the right image
  std::vector<int> partner(width);
  for (std::size_t u = 0; u < width; ++u)
    partner[u] = static_cast<int>(std::floor(static_cast<float>(u) - disparity_px[u] / native_px + 0.5F));
  for (std::size_t u = 0; u < width; ++u) {
    if (partner[u] < 0 || disparity_px[u] <= 0) continue;
    float& best = nearest[static_cast<std::size_t>(partner[u])];
    best = std::max(best, disparity_px[u]);
  }
  std::vector<std::uint8_t> occluded(width, 1);
  for (std::size_t u = 0; u < width; ++u) {
    if (partner[u] < 0) continue;
    occluded[u] = nearest[static_cast<std::size_t>(partner[u])] > disparity_px[u] + kOcclusion_px ? 1 : 0;
  }
  return occluded;
}

/// Reduces the values of `of` within half_window of each pixel by `best`, along rows or columns (step:
/// distance of neighbours). The window is clipped at the border.
template <class Best>
void reduce_windows(const DepthImage& of, int half_window, bool along_rows, const Best& best,
                    const Workers& workers, DepthImage& result) {
  result = of;
  workers.for_rows(of.height, [&](int v) {
    float* out = &result(0, v);
    for (int shift = -half_window; shift <= half_window; ++shift) {
      const int row = along_rows ? v : v + shift;
      if (shift == 0 || row < 0 || row >= of.height) continue;
      const int step = along_rows ? shift : 0;
      const float* in = of.data.data() + of.index(0, row);
      for (int u = std::max(0, -step); u < std::min(of.width, of.width - step); ++u)
        out[u] = best(out[u], in[u + step]);
    }
  });
}

/// Minimum or maximum (`best`) in the square window around each pixel.
template <class Best>
DepthImage in_square_window(const DepthImage& of, int half_window, const Best& best, const Workers& workers) {
  DepthImage across, result;
  reduce_windows(of, half_window, true, best, workers, across);
  reduce_windows(across, half_window, false, best, workers, result);
  return result;
}

/// 0 up to the depth where the dots begin to fade, 1 where they are invisible.
float faded(const StereoSensor& sensor, float depth_m) {
  return std::clamp((depth_m - sensor.fade_begin_m) / (sensor.fade_end_m - sensor.fade_begin_m), 0.0F, 1.0F);
}

DepthImage stereo_depth(const StereoSensor& sensor, const Image<render::Renderer::Surface>& surfaces,
                        const NativePixels& native, std::uint64_t key, const Workers& workers) {
  const float focal_baseline = native.focal_baseline_px_m(sensor.baseline_m);
  const auto native_px = static_cast<float>(native.per_image_px());
  const int half_window = native.in_image(kHalfWindow);
  DepthImage disparity_px(surfaces.width, surfaces.height);
  std::ranges::transform(surfaces.data, disparity_px.data.begin(),
                         [&](const render::Renderer::Surface& surface) {
                           return surface.depth_m > 0 ? focal_baseline / surface.depth_m : 0.0F;
                         });
  const DepthImage least = in_square_window(
      disparity_px, half_window, [](float a, float b) { return std::min(a, b); }, workers);
  const DepthImage most = in_square_window(
      disparity_px, half_window, [](float a, float b) { return std::max(a, b); }, workers);
  const random::SmoothNoise noise(random::mix_key(key, kFieldKey), native.in_image(kNoiseSpacing_px));
  const std::uint64_t fade_key = random::mix_key(key, kFadeKey);
  DepthImage depth_m(surfaces.width, surfaces.height);
  workers.for_rows(surfaces.height, [&](int v) {
    const auto width = static_cast<std::size_t>(surfaces.width);
    const std::vector<std::uint8_t> occluded =
        occluded_in_right(std::span(&disparity_px(0, v), width), native_px);
    std::vector<float> noise_row(width);
    noise.row(v, noise_row);
    for (int u = 0; u < surfaces.width; ++u) {
      const render::Renderer::Surface& surface = surfaces(u, v);
      const float disparity = disparity_px(u, v);
      // Far side of a jump within the window.
      const bool behind_jump =
          most(u, v) - least(u, v) > kJump_px && disparity - least(u, v) < most(u, v) - disparity;
      if (surface.depth_m <= 0 || occluded[static_cast<std::size_t>(u)] != 0 ||
          surface.cos_incidence < kMinCosine || behind_jump)
        continue;
      const float fade = faded(sensor, surface.depth_m);
      if (fade > 0 &&
          random::unit_interval(random::mix_key(fade_key, surfaces.index(u, v))) < static_cast<double>(fade))
        continue;
      const float exact = disparity + sensor.noise_px * (1 + fade) * noise_row[static_cast<std::size_t>(u)];
      const float measured = std::floor(sensor.steps_per_pixel * exact + 0.5F) / sensor.steps_per_pixel;
      if (measured > 0 && measured <= sensor.max_disparity_px) depth_m(u, v) = focal_baseline / measured;
    }
  });
  return depth_m;
}

}  // namespace

DepthImage active_stereo_depth(const Image<render::Renderer::Surface>& surfaces, const NativePixels& native,
                               std::uint64_t key, const Workers& workers) {
  return stereo_depth(kZr300, surfaces, native, key, workers);
}

DepthImage kinect_depth(const Image<render::Renderer::Surface>& surfaces, const NativePixels& native,
                        std::uint64_t key, const Workers& workers) {
  return stereo_depth(kKinect, surfaces, native, key, workers);
}

}  // namespace fusebench::simulator::sensors
