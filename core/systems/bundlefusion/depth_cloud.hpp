// A frame's depth at a small size: points and normals of a grid of some 80x60 cells.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "core/base/types.hpp"

namespace fusebench::systems::bundlefusion {

/// Points and normals in the camera's axes (metres, unit); zero where there is none.
struct DepthCloud {
  PinholeCamera camera;
  Image<Eigen::Vector3f> points;
  Image<Eigen::Vector3f> normals;  ///< towards the camera; only where there is a point

  /// Index of the cell that a point in front of this camera (its axes) falls into, if that has a normal.
  [[nodiscard]] std::optional<std::size_t> cell_at(const Eigen::Vector3f& point_camera) const;
};

/// A cell has the mean of those of its depths that are within 5 cm of the one in its middle; its normal is
/// that of the cells around it.
[[nodiscard]] DepthCloud make_depth_cloud(const DepthImage& depth_m, const PinholeCamera& camera);

/// Calls back for every point of b that has a normal and falls into a cell of a with one: with the cell's
/// index, and with the point and its normal in the axes of a.
template <class Callback>
void for_each_overlap(const DepthCloud& a, const DepthCloud& b, const SE3& T_a_b, const Callback& callback) {
  const Eigen::Matrix3f R = T_a_b.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = T_a_b.translation.cast<float>();
  for (std::size_t i = 0; i < b.points.data.size(); ++i) {
    if (b.normals.data[i].isZero(0)) continue;
    const Eigen::Vector3f point = R * b.points.data[i] + t;
    if (const auto cell = a.cell_at(point)) callback(*cell, point, Eigen::Vector3f(R * b.normals.data[i]));
  }
}

/// Whether two points with their normals, in the same axes, may be of one surface: within 15 cm, and turned
/// by less than 14 degrees (Dai et al. 2017, Sec. 4.2).
[[nodiscard]] bool are_of_one_surface(const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                                      const Eigen::Vector3f& other_point,
                                      const Eigen::Vector3f& other_normal);

}  // namespace fusebench::systems::bundlefusion
