#include "core/baselines/elasticfusion/surfels/surfel_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fusebench::baselines::elasticfusion::surfels {

namespace {

/// Slopes of the rays of the columns and rows of an image.
struct Rays {
  explicit Rays(const PinholeCamera& camera) {
    for (int x = 0; x < camera.width_px; ++x)
      across.push_back(static_cast<float>((x - camera.cx_px) / camera.fx_px));
    for (int y = 0; y < camera.height_px; ++y)
      down.push_back(static_cast<float>((y - camera.cy_px) / camera.fy_px));
  }
  std::vector<float> across;
  std::vector<float> down;
};

class DiscDrawing {
 public:
  DiscDrawing(const Rays& rays, Image<float>& nearest_m, Image<std::int32_t>& drawn)
      : rays_(rays), nearest_m_(nearest_m), drawn_(drawn) {}

  /// Draws the part of a disc within these rows.
  void draw(const CameraSurfel& surfel, std::int32_t number, int first_row, int last_row) const {
    const Eigen::Vector3f &p = surfel.position, &n = surfel.normal;
    const float height = n.dot(p);
    if (!(height < 0)) return;  // faces away from the camera
    const float z = p.z(), r = surfel.radius_m;
    const int top = std::max<int>(first_row, surfel.top), bottom = std::min<int>(last_row, surfel.bottom);
    for (int y = top; y <= bottom; ++y) {
      const float down = rays_.down[static_cast<std::size_t>(y)];
      const float row_slope = n.y() * down + n.z();
      const std::size_t row = nearest_m_.index(0, y);
      for (int x = surfel.left; x <= surfel.right; ++x) {
        const float across = rays_.across[static_cast<std::size_t>(x)];
        const float slope = n.x() * across + row_slope;
        if (!(slope < 0)) continue;
        const float depth = height / slope;
        const float dx = depth * across - p.x(), dy = depth * down - p.y(), dz = depth - z;
        if (dx * dx + dy * dy + dz * dz > r * r) continue;
        const std::size_t pixel = row + static_cast<std::size_t>(x);
        if (!(depth < nearest_m_.data[pixel])) continue;
        nearest_m_.data[pixel] = depth;
        drawn_.data[pixel] = number;
      }
    }
  }

 private:
  const Rays& rays_;
  Image<float>& nearest_m_;
  Image<std::int32_t>& drawn_;
};

}  // namespace

void ViewRenderer::render(const SurfelMap& map, const PinholeCamera& camera, const SE3& T_world_camera,
                          const SurfelChoice& choice, const Workers& workers, SurfelView& view) {
  visible_.find(map, camera, T_world_camera, choice, workers);
  const Rays rays(camera);
  const int width = camera.width_px, height = camera.height_px;
  view.camera = camera;
  view.T_world_camera = T_world_camera;
  view.point.resize(width, height);
  view.normal.resize(width, height);
  view.color.resize(width, height);
  view.surfel.resize(width, height);
  nearest_m_.resize(width, height);
  drawn_.resize(width, height);
  const DiscDrawing drawing(rays, nearest_m_, drawn_);
  const auto surfels = visible_.all();
  const auto resolve = [&](int x, int y) -> std::size_t {
    const std::size_t pixel = drawn_.index(x, y);
    const std::int32_t number = drawn_.data[pixel];
    if (number == kNoSurfel) {
      view.point.put(pixel, Eigen::Vector3f::Zero());
      view.normal.put(pixel, Eigen::Vector3f::Zero());
      view.color.data[pixel] = {};
      view.surfel.data[pixel] = kNoSurfel;
      return 0;
    }
    const CameraSurfel& surfel = surfels[static_cast<std::size_t>(number)];
    const float depth = nearest_m_.data[pixel];
    view.point.put(pixel, {depth * rays.across[static_cast<std::size_t>(x)],
                           depth * rays.down[static_cast<std::size_t>(y)], depth});
    view.normal.put(pixel, surfel.normal);
    view.color.data[pixel] = map.color[surfel.index];
    view.surfel.data[pixel] = static_cast<std::int32_t>(surfel.index);
    return 1;
  };
  const auto seen = workers.map_chunks<std::size_t>(visible_.bands(), 1, [&](std::size_t band, std::size_t) {
    const int first = static_cast<int>(band) * VisibleSurfels::kBandRows;
    const int last = std::min(height, first + VisibleSurfels::kBandRows) - 1;
    for (int y = first; y <= last; ++y) {
      std::fill_n(nearest_m_.data.begin() + static_cast<std::ptrdiff_t>(nearest_m_.index(0, y)), width,
                  std::numeric_limits<float>::infinity());
      std::fill_n(drawn_.data.begin() + static_cast<std::ptrdiff_t>(drawn_.index(0, y)), width, kNoSurfel);
    }
    visible_.for_band(
        band, [&](std::size_t i) { drawing.draw(surfels[i], static_cast<std::int32_t>(i), first, last); });
    std::size_t count = 0;
    for (int y = first; y <= last; ++y) {
      for (int x = 0; x < width; ++x) count += resolve(x, y);
    }
    return count;
  });
  view.seen = std::accumulate(seen.begin(), seen.end(), std::size_t{0});
}

void fill_in(const LiveFrame& live, SurfelView& view) {
  for (int y = 0; y < view.camera.height_px; ++y) {
    for (int x = 0; x < view.camera.width_px; ++x) {
      const std::size_t pixel = view.surfel.index(x, y);
      if (view.surfel.data[pixel] != kNoSurfel) continue;
      const auto depth_m = static_cast<double>(live.smooth_m.data[pixel]);
      view.point.put(pixel, view.camera.back_project(x, y, depth_m).cast<float>());
      view.normal.put(pixel, live.normal.at(pixel));
      view.color.data[pixel] = live.color.data[pixel];
    }
  }
}

}  // namespace fusebench::baselines::elasticfusion::surfels
