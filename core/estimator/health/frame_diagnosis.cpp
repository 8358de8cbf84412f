#include "core/estimator/health/frame_diagnosis.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/health_config.hpp"

namespace fusebench::health {

namespace {

double mean_grey(const GreyImage& image) {
  const auto sum = std::accumulate(image.data.begin(), image.data.end(), std::uint64_t{0});
  return static_cast<double>(sum) / static_cast<double>(image.data.size());
}

/// Share of pixels with a gradient, on a coarse level with little noise.
double texture_share(const GreyImage& image, int gradient_grey) {
  std::size_t textured = 0;
  for (int y = 0; y + 1 < image.height; ++y) {
    for (int x = 0; x + 1 < image.width; ++x) {
      const int dx = image(x + 1, y) - image(x, y);
      const int dy = image(x, y + 1) - image(x, y);
      textured += dx * dx + dy * dy > gradient_grey * gradient_grey ? 1U : 0U;
    }
  }
  return static_cast<double>(textured) / static_cast<double>(image.data.size());
}

}  // namespace

bool is_sound(FrameHealth health) {
  return health != FrameHealth::dark && health != FrameHealth::diverged &&
         health != FrameHealth::short_of_depth && health != FrameHealth::short_of_texture;
}

double depth_share(const DepthImage& depth_m) {
  const auto measured =
      std::count_if(depth_m.data.begin(), depth_m.data.end(), [](float z) { return z > 0; });
  return static_cast<double>(measured) / static_cast<double>(depth_m.data.size());
}

std::string_view to_string(FrameHealth health) {
  switch (health) {
    case FrameHealth::dark:
      return "dark";
    case FrameHealth::occluded:
      return "occluded";
    case FrameHealth::short_of_depth:
      return "short-of-depth";
    case FrameHealth::short_of_texture:
      return "short-of-texture";
    case FrameHealth::inconsistent:
      return "inconsistent";
    case FrameHealth::short_of_patches:
      return "short-of-patches";
    case FrameHealth::blurred:
      return "blurred";
    case FrameHealth::diverged:
      return "diverged";
    case FrameHealth::repeated:
      return "repeated";
    case FrameHealth::revisit_pending:
      return "revisit-pending";
    case FrameHealth::good:
      break;
  }
  return "good";
}

FrameHealth judge_health(const measurement::ObservedFrame& frame,
                         std::span<const measurement::PatchOutcome> outcomes, double blur_px,
                         const config::HealthConfig& health, const config::IekfConfig& iekf,
                         int patch_size_px) {
  if (mean_grey(frame.pyramid.back()) < health.dark_grey) return FrameHealth::dark;
  int in_view = 0, covered = 0, tracked = 0, accepted = 0;
  for (const measurement::PatchOutcome& outcome : outcomes) {
    in_view += outcome.in_view ? 1 : 0;
    covered += 2 * outcome.covered_pixels > outcome.usable_pixels + outcome.covered_pixels ? 1 : 0;
    tracked += outcome.tracked ? 1 : 0;
    accepted += outcome.accepted ? 1 : 0;
  }
  if (in_view > 0 && covered > health.covered_share * in_view) return FrameHealth::occluded;
  if (depth_share(frame.depth_m) < health.min_depth_share) return FrameHealth::short_of_depth;
  if (texture_share(frame.pyramid.back(), health.texture_gradient_grey) < health.min_texture_share)
    return FrameHealth::short_of_texture;
  if (tracked > 0 && 2 * accepted < tracked) return FrameHealth::inconsistent;
  if (accepted < iekf.min_patches && !outcomes.empty()) return FrameHealth::short_of_patches;
  if (blur_px > patch_size_px) return FrameHealth::blurred;
  return FrameHealth::good;
}

FrameHealth judge_start(const measurement::ObservedFrame& frame, std::size_t patches,
                        const config::HealthConfig& health, const config::IekfConfig& iekf,
                        int patch_size_px) {
  const FrameHealth images = judge_health(frame, {}, 0.0, health, iekf, patch_size_px);
  if (images == FrameHealth::dark) return images;
  if (patches >= static_cast<std::size_t>(iekf.min_patches)) return FrameHealth::good;
  return images == FrameHealth::good ? FrameHealth::short_of_patches : images;
}

}  // namespace fusebench::health
