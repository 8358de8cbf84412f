#include "core/baselines/elasticfusion/tracking/pyramids.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::elasticfusion::tracking {

namespace {

constexpr float kOneSurface_m = 0.09F;  // three standard deviations of the depth filter
constexpr std::array<float, 5> kBinomial = {1, 4, 6, 4, 1};

Image<float> as_float(const GreyImage& grey) {
  Image<float> image(grey.width, grey.height);
  std::ranges::transform(grey.data, image.data.begin(),
                         [](std::uint8_t value) { return static_cast<float>(value); });
  return image;
}

/// Half the size: binomial means over the pixels whose depth is close to that of the central one.
Image<float> half_of_surface(const Image<float>& values, const DepthImage& depth_m) {
  Image<float> half((depth_m.width + 1) / 2, (depth_m.height + 1) / 2);
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      const float middle_m = depth_m(2 * x, 2 * y);
      if (!(middle_m > 0)) continue;
      float sum = 0, weights = 0;
      for (int v = std::max(0, 2 * y - 2); v <= std::min(depth_m.height - 1, 2 * y + 2); ++v) {
        for (int u = std::max(0, 2 * x - 2); u <= std::min(depth_m.width - 1, 2 * x + 2); ++u) {
          const std::size_t pixel = depth_m.index(u, v);
          const float there_m = depth_m.data[pixel];
          if (!(there_m > 0) || std::abs(there_m - middle_m) > kOneSurface_m) continue;
          const float weight = kBinomial[static_cast<std::size_t>(u - 2 * x + 2)] *
                               kBinomial[static_cast<std::size_t>(v - 2 * y + 2)];
          sum += weight * values.data[pixel];
          weights += weight;
        }
      }
      half(x, y) = sum / weights;
    }
  }
  return half;
}

/// Means of four points and of their normals.
void halve_points(const ViewLevel& fine, ViewLevel& coarse) {
  const int width = coarse.camera.width_px, height = coarse.camera.height_px;
  coarse.point.resize(width, height);
  coarse.normal.resize(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      // For odd sizes, the last column or row is used twice.
      const int right = std::min(2 * x + 1, fine.camera.width_px - 1);
      const int below = std::min(2 * y + 1, fine.camera.height_px - 1);
      Eigen::Vector3f point = Eigen::Vector3f::Zero(), normal = point;
      bool all = true;
      for (const auto& [u, v] : {std::pair{2 * x, 2 * y}, {right, 2 * y}, {2 * x, below}, {right, below}}) {
        const std::size_t pixel = fine.point.x.index(u, v);
        all = all && fine.point.z.data[pixel] > 0;
        point += fine.point.at(pixel);
        normal += fine.normal.at(pixel);
      }
      const std::size_t target = coarse.point.x.index(x, y);
      coarse.point.put(target, all ? Eigen::Vector3f(0.25F * point) : Eigen::Vector3f::Zero());
      coarse.normal.put(target, all ? normal.normalized() : Eigen::Vector3f::Zero());
    }
  }
}

/// Builds levels without intensities.
LivePyramid surface_levels(const DepthImage& depth_m, const PointMap& normal, const PinholeCamera& camera,
                           const Workers& workers) {
  LivePyramid levels;
  for (int number = 0; number < kLevels; ++number) {
    const auto at = static_cast<std::size_t>(number);
    LiveLevel& level = levels[at];
    level.camera = camera_of_level(camera, number);
    level.depth_m = number == 0 ? depth_m : half_depth(levels[at - 1].depth_m);
    level.normal = number == 0 ? normal : surfels::normals_of(level.depth_m, level.camera, workers);
  }
  return levels;
}

/// Sets the gradient to zero where one of the eight neighbours has no surface, and so no intensity.
void flatten_beside_holes(const DepthImage& depth_m, Gradient& gradient) {
  const auto has_hole = [&](int x, int y) {
    for (int v = std::max(0, y - 1); v <= std::min(depth_m.height - 1, y + 1); ++v) {
      for (int u = std::max(0, x - 1); u <= std::min(depth_m.width - 1, x + 1); ++u) {
        if (!(depth_m(u, v) > 0)) return true;
      }
    }
    return false;
  };
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      if (!has_hole(x, y)) continue;
      const std::size_t pixel = depth_m.index(x, y);
      gradient.dx.data[pixel] = gradient.dy.data[pixel] = 0;
    }
  }
}

}  // namespace

PinholeCamera camera_of_level(const PinholeCamera& camera, int level) {
  const double scale = std::ldexp(1.0, -level);
  PinholeCamera half = camera;
  for (int i = 0; i < level; ++i) {
    half.width_px = (half.width_px + 1) / 2;
    half.height_px = (half.height_px + 1) / 2;
  }
  for (double* const number : {&half.fx_px, &half.fy_px, &half.cx_px, &half.cy_px}) *number *= scale;
  return half;
}

DepthImage half_depth(const DepthImage& depth_m) { return half_of_surface(depth_m, depth_m); }

LivePyramid live_pyramid(const surfels::LiveFrame& live, const PinholeCamera& camera,
                         const Workers& workers) {
  LivePyramid levels = surface_levels(live.smooth_m, live.normal, camera, workers);
  const std::vector<GreyImage> grey = build_pyramid(live.grey, kLevels);
  for (std::size_t number = 0; number < levels.size(); ++number) {
    levels[number].intensity = as_float(grey[number]);
    levels[number].gradient = gradient_of(levels[number].intensity);
  }
  return levels;
}

LivePyramid live_pyramid(const surfels::SurfelView& view, config::PeerDefects defects,
                         const Workers& workers) {
  const GreyImage grey = surfels::intensity_of(view.color, defects);
  if (defects == config::PeerDefects::as_published)
    return live_pyramid({view.point.z, view.point.z, view.normal, view.color, grey}, view.camera, workers);
  LivePyramid levels = surface_levels(view.point.z, view.normal, view.camera, workers);
  for (std::size_t number = 0; number < levels.size(); ++number) {
    LiveLevel& level = levels[number];
    level.intensity = number == 0 ? as_float(grey)
                                  : half_of_surface(levels[number - 1].intensity, levels[number - 1].depth_m);
    level.gradient = gradient_of(level.intensity);
    flatten_beside_holes(level.depth_m, level.gradient);
  }
  return levels;
}

ViewPyramid view_pyramid(const surfels::SurfelView& view, config::PeerDefects defects) {
  ViewPyramid levels;
  levels[0] = {view.camera, view.point, view.normal, as_float(surfels::intensity_of(view.color, defects)),
               view.point.z};
  for (std::size_t number = 1; number < levels.size(); ++number) {
    const ViewLevel& fine = levels[number - 1];
    ViewLevel& level = levels[number];
    level.camera = camera_of_level(view.camera, static_cast<int>(number));
    halve_points(fine, level);
    level.depth_m = half_depth(fine.depth_m);
    level.intensity = half_of_surface(fine.intensity, fine.depth_m);
  }
  return levels;
}

}  // namespace fusebench::baselines::elasticfusion::tracking
