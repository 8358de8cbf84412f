#include "core/estimator/patches/patch_lanes.hpp"

#include <algorithm>

namespace fusebench::patches {

namespace {

void set(simd::Points& points, std::size_t lane, const Eigen::Vector3f& value) {
  points.x[lane] = value.x();
  points.y[lane] = value.y();
  points.z[lane] = value.z();
}

}  // namespace

PosedLanes::PosedLanes(const PosedCamera& posed, const Vector3d& origin_world)
    : width_px(posed.camera.width_px),
      height_px(posed.camera.height_px),
      fx_px(static_cast<float>(posed.camera.fx_px)),
      fy_px(static_cast<float>(posed.camera.fy_px)),
      cx_px(static_cast<float>(posed.camera.cx_px)),
      cy_px(static_cast<float>(posed.camera.cy_px)),
      per_fx(static_cast<float>(1.0 / posed.camera.fx_px)),
      per_fy(static_cast<float>(1.0 / posed.camera.fy_px)),
      R_camera_world(posed.R_camera_world.cast<float>()),
      t_camera_m(posed.to_camera(origin_world).cast<float>()),
      R_imu_camera(posed.R_imu_camera.cast<float>()),
      t_imu_camera_m(posed.t_imu_camera_m.cast<float>()),
      R_world_imu(posed.R_world_imu.cast<float>()),
      t_world_imu_m((posed.t_world_imu_m - origin_world).cast<float>()) {}

void pack(std::span<const Patch> patches, std::size_t level, const Vector3d& origin_world,
          LevelLanes& lanes) {
  lanes.pixels.clear();
  lanes.warp_points.clear();
  lanes.first.assign(1, 0);
  for (const Patch& patch : patches) {
    const auto& [pixels, warp_points] = patch.levels[level];
    for (std::size_t begin = 0; begin < pixels.size(); begin += simd::kLanes) {
      PixelLanes& group = lanes.pixels.emplace_back();
      if (!warp_points.empty()) lanes.warp_points.emplace_back();
      for (std::size_t lane = 0; lane < simd::kLanes; ++lane) {
        const std::size_t i = std::min(begin + lane, pixels.size() - 1);
        const PatchPixel& pixel = pixels[i];
        const bool present = begin + lane < pixels.size();
        set(group.point, lane, (pixel.point_world - origin_world).cast<float>());
        set(group.normal, lane, pixel.normal_world);
        group.intensity[lane] = pixel.intensity;
        group.present[lane] = present ? -1 : 0;
        group.depth_confirmed[lane] = present && pixel.depth_confirmed ? -1 : 0;
        if (warp_points.empty()) continue;
        WarpPointLanes& warp = lanes.warp_points.back();
        set(warp.point, lane, (warp_points[i].point_world - origin_world).cast<float>());
        warp.offset_x[lane] = static_cast<float>(warp_points[i].offset_px.x());
        warp.offset_y[lane] = static_cast<float>(warp_points[i].offset_px.y());
      }
    }
    lanes.first.push_back(lanes.pixels.size());
  }
  lanes.warped.resize(lanes.pixels.size());
}

}  // namespace fusebench::patches
