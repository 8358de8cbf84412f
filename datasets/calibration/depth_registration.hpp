// Registration of depth to another camera.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::calibration {

/// Carries depth images of a depth camera into a colour camera, both without distortion.
///
/// Every measurement is projected forward and covers a small rectangle of the colour image: up to half way to
/// the next measurement where both lie on one surface, and half a pixel of the depth camera where the surface
/// ends. So a surface has no holes between its measurements, and its edges stay where they are. Within its
/// rectangle a measurement follows the slope between its neighbours. Where several land, the nearest wins: a
/// surface hides what lies behind it. Pixels that no measurement reaches are 0.
class DepthRegistration {
 public:
  DepthRegistration(const PinholeCamera& depth_camera, const PinholeCamera& color_camera,
                    const SE3& T_color_depth);

  /// depth_m: image of the depth camera's size (checked). The result has the colour camera's size.
  [[nodiscard]] DepthImage register_depth(const DepthImage& depth_m) const;

  [[nodiscard]] const PinholeCamera& depth_camera() const { return depth_camera_; }

 private:
  PinholeCamera depth_camera_;
  PinholeCamera color_camera_;
  // (u z', v z', z') of the colour image = z (ray_by_u u + ray_by_v v + ray_at_origin) + offset
  Eigen::Vector3f ray_by_u_;
  Eigen::Vector3f ray_by_v_;
  Eigen::Vector3f ray_at_origin_;
  Eigen::Vector3f offset_;
  float pixel_scale_;  ///< pixels of the colour image per pixel of the depth image, at equal depth
};

}  // namespace fusebench::calibration
