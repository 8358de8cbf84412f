// Stable surfaces of the model that were measured in the current frame. Surfels in front of them are
// contradicted.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

/// Depths of surfels that were measured in this frame, by pixel.
class SeenSurface {
 public:
  explicit SeenSurface(const PinholeCamera& camera);

  /// Adds a stable surfel that was measured in this frame; camera frame, z > 0.
  void add(const Eigen::Vector3f& point_camera);

  /// True if the measured surface is behind an unmeasured surfel: at least two measured surfels within a
  /// pixel are more than 1 cm behind it, and none is nearer. False for surfels at a grazing angle.
  [[nodiscard]] bool is_behind(const Eigen::Vector3f& point_camera,
                               const Eigen::Vector3f& normal_camera) const;

 private:
  [[nodiscard]] bool place(const Eigen::Vector3f& point_camera, int& x, int& y) const;

  PinholeCamera camera_;
  Image<float> nearest_m_;            ///< smallest depth of the surfels of each pixel; 0 if there is none
  Image<std::uint8_t> measurements_;  ///< number of surfels of each pixel
};

}  // namespace fusebench::baselines::elasticfusion::surfels
