#include "core/baselines/elasticfusion/surfels/visible_surfels.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::baselines::elasticfusion::surfels {

namespace {

constexpr std::size_t kSurfelsAtOnce = 16384;
constexpr float kNearest_m = 0.05F;

/// Slopes that an interval covers over a range of depths.
struct Slopes {
  float low;
  float high;

  Slopes(float middle, float reach, float nearest_m, float farthest_m) {
    const float begin = middle - reach, end = middle + reach;
    low = begin / (begin < 0 ? nearest_m : farthest_m);
    high = end / (end > 0 ? nearest_m : farthest_m);
  }
};

/// Extent of a disc along an axis, given the component of its normal along that axis.
float reach_along(const CameraSurfel& surfel, float normal_part) {
  return surfel.radius_m * std::sqrt(std::max(0.0F, 1 - normal_part * normal_part));
}

/// Sets the range of pixels that the surfel may cover and the pixel nearest to its centre; false if it is
/// outside the image.
bool put_bounds(const PinholeCamera& camera, CameraSurfel& surfel) {
  const Eigen::Vector3f &p = surfel.position, &n = surfel.normal;
  const float depth = reach_along(surfel, n.z());
  const float nearest_m = std::max(kNearest_m, p.z() - depth), farthest_m = p.z() + depth;
  const Slopes across(p.x(), reach_along(surfel, n.x()), nearest_m, farthest_m);
  const Slopes down(p.y(), reach_along(surfel, n.y()), nearest_m, farthest_m);
  const auto fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  const float left = fx * across.low + cx - 0.5F, right = fx * across.high + cx + 0.5F;
  const float top = fy * down.low + cy - 0.5F, bottom = fy * down.high + cy + 0.5F;
  const auto width = static_cast<float>(camera.width_px), height = static_cast<float>(camera.height_px);
  if (!(right >= 0) || !(left < width) || !(bottom >= 0) || !(top < height)) return false;
  surfel.left = static_cast<std::int16_t>(std::max(0.0F, std::ceil(left)));
  surfel.top = static_cast<std::int16_t>(std::max(0.0F, std::ceil(top)));
  surfel.right = static_cast<std::int16_t>(std::min(width - 1, std::floor(right)));
  surfel.bottom = static_cast<std::int16_t>(std::min(height - 1, std::floor(bottom)));
  return surfel.left <= surfel.right && surfel.top <= surfel.bottom;
}

}  // namespace

void VisibleSurfels::find(const SurfelMap& map, const PinholeCamera& camera, const SE3& T_world_camera,
                          const SurfelChoice& choice, const Workers& workers) {
  const SE3 T_camera_world = T_world_camera.inverse();
  const Eigen::Matrix3f R = T_camera_world.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = T_camera_world.translation.cast<float>();
  bands_ = static_cast<std::size_t>((camera.height_px + kBandRows - 1) / kBandRows);
  parts_.resize((map.size() + kSurfelsAtOnce - 1) / kSurfelsAtOnce);
  workers.for_chunks(map.size(), kSurfelsAtOnce, [&](std::size_t begin, std::size_t end) {
    Part& part = parts_[begin / kSurfelsAtOnce];
    part.surfels.clear();
    part.of_band.resize(bands_);
    for (auto& band : part.of_band) band.clear();
    for (std::size_t i = begin; i < end; ++i) {
      if (!choice.takes(map, i)) continue;
      const Eigen::Vector3f position = R * map.position[i] + t;
      if (!(position.z() > kNearest_m)) continue;
      CameraSurfel surfel{
          position, R * map.normal[i], map.radius_m[i], static_cast<std::uint32_t>(i), 0, 0, 0, 0};
      if (!put_bounds(camera, surfel)) continue;
      const auto number = static_cast<std::uint32_t>(part.surfels.size());
      part.surfels.push_back(surfel);
      for (int band = surfel.top / kBandRows; band <= surfel.bottom / kBandRows; ++band)
        part.of_band[static_cast<std::size_t>(band)].push_back(number);
    }
  });
  std::size_t count = 0;
  for (Part& part : parts_) {
    part.first = count;
    count += part.surfels.size();
  }
  all_.resize(count);
  workers.for_chunks(parts_.size(), 1, [&](std::size_t begin, std::size_t /*end*/) {
    std::ranges::copy(parts_[begin].surfels, all_.begin() + static_cast<std::ptrdiff_t>(parts_[begin].first));
  });
}

}  // namespace fusebench::baselines::elasticfusion::surfels
