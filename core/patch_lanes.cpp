#include "core/patch_lanes.hpp"

#include <algorithm>

namespace fusebench {

namespace {

void set(Points& points, std::size_t lane, const Vector3d& value) {
  points.x[lane] = static_cast<float>(value.x());
  points.y[lane] = static_cast<float>(value.y());
  points.z[lane] = static_cast<float>(value.z());
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
          Deformation deformation, LevelLanes& lanes) {
  const bool own_points = deformation == Deformation::pixelwise;
  lanes.pixels.clear();
  lanes.warp_points.clear();
  lanes.first.assign(1, 0);
  for (const Patch& patch : patches) {
    const std::vector<PatchPixel>& pixels = patch.levels[level].pixels;
    for (std::size_t begin = 0; begin < pixels.size(); begin += kLanes) {
      PixelLanes& eight = lanes.pixels.emplace_back();
      if (!own_points) lanes.warp_points.emplace_back();
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const PatchPixel& pixel = pixels[std::min(begin + lane, pixels.size() - 1)];
        const bool present = begin + lane < pixels.size();
        set(eight.point, lane, pixel.point_world - origin_world);
        set(eight.normal, lane, pixel.normal_world);
        eight.intensity[lane] = static_cast<float>(pixel.intensity);
        eight.present[lane] = present ? -1 : 0;
        eight.depth_confirmed[lane] = present && pixel.depth_confirmed ? -1 : 0;
        if (own_points) continue;
        WarpPointLanes& warp = lanes.warp_points.back();
        set(warp.point, lane, pixel.warp_point_world - origin_world);
        warp.offset_x[lane] = static_cast<float>(pixel.warp_offset_px.x());
        warp.offset_y[lane] = static_cast<float>(pixel.warp_offset_px.y());
      }
    }
    lanes.first.push_back(lanes.pixels.size());
  }
  lanes.warped.resize(lanes.pixels.size());
}

}  // namespace fusebench
