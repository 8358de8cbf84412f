#include "core/estimator/alignment/reference_points.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "core/config/groups/alignment_config.hpp"
#include "core/estimator/patches/posed_camera.hpp"

namespace fusebench::alignment {

namespace {

constexpr int kLeastHeight_px = 8;

/// Smallest depth within the footprint of a coarse pixel: the nearest surface occludes the others.
float nearest_depth_m(const DepthImage& depth_m, int x, int y, int reach_px) {
  float nearest = 0;
  const int step = std::max(1, reach_px);
  for (int v = std::max(0, y - reach_px); v <= std::min(depth_m.height - 1, y + reach_px); v += step) {
    for (int u = std::max(0, x - reach_px); u <= std::min(depth_m.width - 1, x + reach_px); u += step) {
      const float z = depth_m(u, v);
      if (z > 0 && (nearest == 0 || z < nearest)) nearest = z;
    }
  }
  return nearest;
}

/// Zero if alignment is switched off.
int alignment_levels(const PinholeCamera& camera, const config::AlignmentConfig& config) {
  if (config.coarsest_level < config.finest_level) return 0;
  int levels = 1;
  while (levels <= config.coarsest_level && (camera.height_px >> levels) >= kLeastHeight_px) ++levels;
  return levels > config.finest_level ? levels : 0;
}

}  // namespace

void ReferencePoints::take(std::span<const GreyImage> pyramid, const DepthImage& depth_m,
                           const PinholeCamera& camera, const config::AlignmentConfig& config) {
  const int levels = alignment_levels(camera, config);
  finest_ = config.finest_level;
  levels_.resize(static_cast<std::size_t>(std::max(0, levels - finest_)));
  for (int level = finest_; level < levels; ++level) {
    const GreyImage& image = pyramid[static_cast<std::size_t>(level)];
    std::vector<ReferencePoint>& points = levels_[static_cast<std::size_t>(level - finest_)];
    points.clear();
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const int u = x << level;
        const int v = y << level;
        if (!depth_m.contains(u, v)) continue;
        const float z = nearest_depth_m(depth_m, u, v, (1 << level) / 2);
        if (z > 0)
          points.push_back(
              {camera.back_project(u, v, static_cast<double>(z)), static_cast<double>(image(x, y))});
      }
    }
  }
}

std::span<const ReferencePoint> ReferencePoints::level(int level) const {
  check(level >= finest_ && level <= coarsest_level(), "an alignment level that was taken");
  return levels_[static_cast<std::size_t>(level - finest_)];
}

int pyramid_levels(const PinholeCamera& camera, int patch_levels, const config::AlignmentConfig& alignment) {
  return std::max(patch_levels, alignment_levels(camera, alignment));
}

}  // namespace fusebench::alignment
