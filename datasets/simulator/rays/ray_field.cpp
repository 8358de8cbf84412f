#include "datasets/simulator/rays/ray_field.hpp"

namespace fusebench::simulator::rays {

namespace {

/// Bilinear interpolation within each pixel of row v, at fractions fx and fy.
void interpolate_row(const Image<float>& corners, int v, float fx, float fy, std::span<float> values) {
  const float* above = &corners(0, v);
  const float* below = &corners(0, v + 1);
  for (std::size_t u = 0; u < values.size(); ++u) {
    const float top = above[u] + fx * (above[u + 1] - above[u]);
    const float bottom = below[u] + fx * (below[u + 1] - below[u]);
    values[u] = top + fy * (bottom - top);
  }
}

}  // namespace

RayField::RayField(const calibration::CalibratedCamera& camera, const Workers& workers)
    : camera_(camera.pinhole) {
  if (camera.distortion.is_zero()) return;
  corners_x_ = {camera_.width_px + 1, camera_.height_px + 1};
  corners_y_ = corners_x_;
  workers.for_rows(corners_x_.height, [&](int y) {
    for (int x = 0; x < corners_x_.width; ++x) {
      const Vector2d distorted = camera_.back_project(x - 0.5, y - 0.5, 1.0).head<2>();
      const Vector2d ideal = camera.distortion.undistort(distorted);
      corners_x_(x, y) = static_cast<float>(ideal.x());
      corners_y_(x, y) = static_cast<float>(ideal.y());
    }
  });
}

void RayField::row(int v, const Vector2d& offset_px, std::span<float> x, std::span<float> y) const {
  if (corners_x_.empty()) {
    const Vector3d first = camera_.back_project(offset_px.x(), v + offset_px.y(), 1.0);
    const double step = 1.0 / camera_.fx_px;
    for (std::size_t u = 0; u < x.size(); ++u) {
      x[u] = static_cast<float>(first.x() + step * static_cast<double>(u));
      y[u] = static_cast<float>(first.y());
    }
    return;
  }
  const Eigen::Vector2f fraction = (offset_px + Vector2d(0.5, 0.5)).cast<float>();
  interpolate_row(corners_x_, v, fraction.x(), fraction.y(), x);
  interpolate_row(corners_y_, v, fraction.x(), fraction.y(), y);
}

}  // namespace fusebench::simulator::rays
