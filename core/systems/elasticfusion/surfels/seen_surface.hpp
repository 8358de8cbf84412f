// Where a frame has measured surfaces that the model knows well: what lies in front of them is not there.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::systems::elasticfusion::surfels {

/// Depths of surfels that were measured in this frame, by pixel.
class SeenSurface {
 public:
  explicit SeenSurface(const PinholeCamera& camera);

  /// A stable surfel that was measured now; camera frame, in front of it.
  void add(const Eigen::Vector3f& point_camera);

  /// True if the surface lies behind a surfel that was not measured now: at least two measured ones within a
  /// pixel are more than 1 cm behind it, and none is nearer than that. Surfels at a grazing angle are left.
  [[nodiscard]] bool is_behind(const Eigen::Vector3f& point_camera,
                               const Eigen::Vector3f& normal_camera) const;

 private:
  [[nodiscard]] bool place(const Eigen::Vector3f& point_camera, int& x, int& y) const;

  PinholeCamera camera_;
  Image<float> nearest_m_;            ///< of the surfels of each pixel; 0 where there is none
  Image<std::uint8_t> measurements_;  ///< their number
};

}  // namespace fusebench::systems::elasticfusion::surfels
