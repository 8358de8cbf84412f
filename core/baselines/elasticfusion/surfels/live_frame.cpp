#include "core/baselines/elasticfusion/surfels/live_frame.hpp"

#include <algorithm>

#include "core/baselines/elasticfusion/surfels/smooth_depth.hpp"
#include "core/baselines/image_rows.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

namespace {

Eigen::Vector3f point_at(const DepthImage& depth_m, const PinholeCamera& camera, int x, int y) {
  return camera.back_project(x, y, static_cast<double>(depth_m(x, y))).cast<float>();
}

bool is_measured_around(const DepthImage& depth_m, int x, int y) {
  return depth_m(x, y) > 0 && depth_m(x - 1, y) > 0 && depth_m(x + 1, y) > 0 && depth_m(x, y - 1) > 0 &&
         depth_m(x, y + 1) > 0;
}

}  // namespace

PointMap normals_of(const DepthImage& depth_m, const PinholeCamera& camera, const Workers& workers) {
  PointMap normal;
  normal.resize(depth_m.width, depth_m.height);
  const auto put_row = [&](int y) {
    for (int x = 0; x < depth_m.width; ++x) {
      Eigen::Vector3f direction = Eigen::Vector3f::Zero();
      const bool inside = x > 0 && y > 0 && x + 1 < depth_m.width && y + 1 < depth_m.height;
      if (inside && is_measured_around(depth_m, x, y)) {
        const Eigen::Vector3f across =
            point_at(depth_m, camera, x + 1, y) - point_at(depth_m, camera, x - 1, y);
        const Eigen::Vector3f down =
            point_at(depth_m, camera, x, y + 1) - point_at(depth_m, camera, x, y - 1);
        // y points down, so down x across points towards the camera.
        direction = down.cross(across).normalized();
      }
      normal.put(normal.x.index(x, y), direction);
    }
  };
  workers.for_chunks(static_cast<std::size_t>(depth_m.height), kRowsAtOnce,
                     [&](std::size_t begin, std::size_t end) {
                       for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) put_row(y);
                     });
  return normal;
}

GreyImage intensity_of(const ColorImage& color, config::PeerDefects defects) {
  if (defects == config::PeerDefects::fixed) return to_grey(color);
  ColorImage exchanged = color;
  for (Rgb& pixel : exchanged.data) std::swap(pixel[0], pixel[2]);
  return to_grey(exchanged);
}

LiveFrame make_live_frame(const RgbdFrame& frame, const PinholeCamera& camera,
                          const config::DepthConfig& depth, config::PeerDefects defects,
                          const Workers& workers) {
  LiveFrame live;
  live.raw_m = frame.depth_m;
  for (float& depth_m : live.raw_m.data) {
    const auto measured = static_cast<double>(depth_m);
    if (!(measured >= depth.min_m && measured <= depth.max_m)) depth_m = 0;
  }
  live.smooth_m = smooth_depth(live.raw_m, workers);
  live.normal = normals_of(live.smooth_m, camera, workers);
  live.color = frame.color;
  live.grey = intensity_of(frame.color, defects);
  return live;
}

}  // namespace fusebench::baselines::elasticfusion::surfels
