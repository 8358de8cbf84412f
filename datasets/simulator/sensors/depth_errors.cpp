// The sizes of the fixed errors are options. The rules for missing depth and their constants are assumptions
// from depth images of a Kinect (TUM freiburg1): no depth on black monitors and chair legs beyond about a
// metre; on glossy tables only in views from above; a decreasing share between 70 and 80 degrees.
#include "datasets/simulator/sensors/depth_errors.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/random/smooth_noise.hpp"

namespace fusebench::simulator::sensors {

namespace {

using Surface = render::Renderer::Surface;

constexpr double kBaseline_m = 0.075;  // of a Kinect
constexpr int kSmoothSpacing_px = 80;  // pixels of the sensor, as kPatchSpacing_px
constexpr int kPatchSpacing_px = 14;   // holes are larger than single pixels
constexpr std::size_t kRowsPerChunk = 16;

// Shares of width and height: margins without depth in freiburg1, 10, 44, 37 and 3 of 640 x 480 px, outside
// the view of the infrared camera.
constexpr double kLeft = 10 / 640.0;
constexpr double kRight = 44 / 640.0;
constexpr double kAbove = 37 / 480.0;
constexpr double kBelow = 3 / 480.0;

constexpr float kGrazingCosine = 0.26F;  // 75 degrees
constexpr float kGrazingSoft = 0.03F;
constexpr float kLeastSignal = 0.011F;   // infrared reflectance * cosine / z^2 [1/m^2]
constexpr float kInfrared = 0.011F;      // infrared reflectance of black surfaces
constexpr float kSignalSoft = 0.25F;     // relative
constexpr float kGlossLost = 0.5F;       // share of the light that a fully glossy surface reflects elsewhere
constexpr float kMirrorCosine = 0.992F;  // near mirror reflection of the projector, the sensor is saturated

bool is_in_border(const Image<Surface>& surfaces, int u, int v) {
  const int width = surfaces.width;
  const int height = surfaces.height;
  return u < kLeft * width || u >= width - kRight * width || v < kAbove * height ||
         v >= height - kBelow * height;
}

/// True if the light of the projector is not received. noise: standard normal, common to a small patch.
bool is_lost(const Surface& surface, float noise) {
  if (surface.cos_incidence < kGrazingCosine + kGrazingSoft * noise) return true;
  const float spread = 1 - kGlossLost * surface.gloss * (1 - surface.cos_incidence);
  const float reflectance = kInfrared + (1 - kInfrared) * surface.reflectance;
  const float signal = reflectance * spread * surface.cos_incidence / (surface.depth_m * surface.depth_m);
  if (signal < kLeastSignal * (1 + kSignalSoft * noise)) return true;
  return surface.gloss > 0.6F && surface.cos_incidence > kMirrorCosine + 0.003F * noise;
}

}  // namespace

void apply_depth_errors(const DepthErrors& errors, const NativePixels& native, std::uint64_t sensor_key,
                        std::uint64_t frame_key, const Workers& workers, Image<Surface>& surfaces) {
  const float focal_baseline = native.focal_baseline_px_m(kBaseline_m);
  const random::SmoothNoise smooth(random::mix_key(sensor_key, 1), native.in_image(kSmoothSpacing_px));
  const random::SmoothNoise patches(frame_key, native.in_image(kPatchSpacing_px));
  const std::uint64_t pattern_key = random::mix_key(sensor_key, 2);
  const random::NormalTable& normal = random::NormalTable::instance();
  const auto rows = static_cast<std::size_t>(surfaces.height);
  workers.for_chunks(rows, kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    std::vector<float> smooth_row(static_cast<std::size_t>(surfaces.width));
    std::vector<float> patch_row(smooth_row.size());
    for (auto v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      smooth.row(v, smooth_row);
      patches.row(v, patch_row);
      for (int u = 0; u < surfaces.width; ++u) {
        Surface& surface = surfaces(u, v);
        if (surface.depth_m <= 0) continue;
        const auto column = static_cast<std::size_t>(u);
        const bool lost = errors.lost_light && is_lost(surface, patch_row[column]);
        if (lost || (errors.border && is_in_border(surfaces, u, v))) {
          surface.depth_m = 0;
          continue;
        }
        float disparity_px = focal_baseline / surface.depth_m;
        if (errors.smooth_px > 0) disparity_px += static_cast<float>(errors.smooth_px) * smooth_row[column];
        if (errors.pattern_px > 0)
          disparity_px += static_cast<float>(errors.pattern_px) *
                          normal(random::mix_key(pattern_key, surfaces.index(u, v)));
        surface.depth_m =
            disparity_px > 0 ? focal_baseline / disparity_px * static_cast<float>(1 + errors.scale) : 0.0F;
      }
    }
  });
}

}  // namespace fusebench::simulator::sensors
