// Patches in the memory layout of the update: eight pixels at a time, in single precision. Coordinates are
// relative to the reference camera, so the rounding error is below the measurement noise.
#pragma once

#include <span>
#include <vector>

#include "core/base/simd/lane_points.hpp"
#include "core/estimator/patches/patches.hpp"
#include "core/estimator/patches/posed_camera.hpp"

namespace fusebench::patches {

/// A posed camera (posed_camera.hpp) for points relative to an origin: X_camera = R_camera_world * (P_world -
/// origin_world) + t_camera_m.
struct PosedLanes {
  PosedLanes(const PosedCamera& posed, const Vector3d& origin_world);

  [[nodiscard]] simd::Points to_camera(const simd::Points& point) const {
    return simd::moved(R_camera_world, t_camera_m, point);
  }
  [[nodiscard]] simd::Points to_imu(const simd::Points& point_camera) const {
    return simd::moved(R_imu_camera, t_imu_camera_m, point_camera);
  }
  [[nodiscard]] simd::Points back_project(simd::Float8 u, simd::Float8 v, simd::Float8 depth_m) const {
    return {(u - cx_px) * per_fx * depth_m, (v - cy_px) * per_fy * depth_m, depth_m};
  }

  int width_px, height_px;
  float fx_px, fy_px, cx_px, cy_px;
  float per_fx, per_fy;
  Eigen::Matrix3f R_camera_world;
  Eigen::Vector3f t_camera_m;
  Eigen::Matrix3f R_imu_camera;
  Eigen::Vector3f t_imu_camera_m;
  Eigen::Matrix3f R_world_imu;
  Eigen::Vector3f t_world_imu_m;  ///< relative to the origin
};

/// Eight pixels of one level of a patch (PatchPixel). Unused lanes repeat the last pixel.
struct PixelLanes {
  simd::Points point;   ///< model surface
  simd::Points normal;  ///< of the model surface, world axes
  simd::Float8 intensity{};
  simd::Int8 present{};          ///< lane is used
  simd::Int8 depth_confirmed{};  ///< lane is used, and its colour is valid for alignment
};

/// Points that are projected instead of the surface points, if the deformation is not by pixel.
struct WarpPointLanes {
  simd::Points point;
  simd::Float8 offset_x{};  ///< pixels of the level
  simd::Float8 offset_y{};
};

/// Eight pixels in the current frame (Eq. 2), pixel coordinates of their level.
struct WarpedLanes {
  simd::Float8 x{};
  simd::Float8 y{};
  simd::Float8 depth_m{};  ///< z of the surface point of the pixel
  simd::Int8 in_image{};   ///< in front of the camera and inside the image, with the interpolation margin
  simd::Int8 visible{};    ///< in_image and not occluded
  simd::Int8 covered{};    ///< in_image, behind a nearer measured surface
};

/// One pyramid level of all patches.
struct LevelLanes {
  std::vector<PixelLanes> pixels;
  std::vector<WarpPointLanes> warp_points;  ///< one each; empty if pixels use their own points
  std::vector<WarpedLanes> warped;          ///< one each
  std::vector<std::size_t> first;           ///< index of the first entry of each patch, and the end

  /// The points to project for eight pixels.
  [[nodiscard]] const simd::Points& projected(std::size_t eight) const {
    return warp_points.empty() ? pixels[eight].point : warp_points[eight].point;
  }
  [[nodiscard]] std::span<const PixelLanes> pixels_of(std::size_t patch) const {
    return std::span(pixels).subspan(first[patch], first[patch + 1] - first[patch]);
  }
  [[nodiscard]] std::span<const WarpedLanes> warped_of(std::size_t patch) const {
    return std::span(warped).subspan(first[patch], first[patch + 1] - first[patch]);
  }
  [[nodiscard]] std::span<WarpedLanes> warped_of(std::size_t patch) {
    return std::span(warped).subspan(first[patch], first[patch + 1] - first[patch]);
  }
};

/// Copies a level of all patches to `lanes` and reuses its memory.
void pack(std::span<const Patch> patches, std::size_t level, const Vector3d& origin_world, LevelLanes& lanes);

}  // namespace fusebench::patches
