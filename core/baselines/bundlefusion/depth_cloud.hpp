// Depth of a frame at a small size: points and normals on a grid of about 80x60 cells.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "core/base/types.hpp"

namespace fusebench::baselines::bundlefusion {

/// Points and normals in camera axes (metres, unit); zero if missing.
struct DepthCloud {
  PinholeCamera camera;
  Image<Eigen::Vector3f> points;
  Image<Eigen::Vector3f> normals;  ///< towards the camera; zero without a point

  /// Index of the cell at the projection of a point (camera axes, z > 0), if the cell has a normal.
  [[nodiscard]] std::optional<std::size_t> cell_at(const Eigen::Vector3f& point_camera) const;
};

/// Each cell has the mean of its depths within 5 cm of the central one. Its normal is from the surrounding
/// cells.
[[nodiscard]] DepthCloud make_depth_cloud(const DepthImage& depth_m, const PinholeCamera& camera);

/// For each point of b with a normal that projects to a cell of a with a normal, calls the callback with the
/// index of the cell, the point and its normal, in the axes of a.
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

/// True if two points with normals, in the same axes, may belong to one surface: distance below 15 cm, angle
/// below 14 degrees (Dai et al. 2017, Sec. 4.2).
[[nodiscard]] bool are_of_one_surface(const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                                      const Eigen::Vector3f& other_point,
                                      const Eigen::Vector3f& other_normal);

}  // namespace fusebench::baselines::bundlefusion
