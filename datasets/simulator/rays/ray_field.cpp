#include "datasets/simulator/rays/ray_field.hpp"

namespace fusebench::simulator::rays {

RayField::RayField(const calibration::CalibratedCamera& camera, const Workers& workers)
    : camera_(camera.pinhole) {
  if (camera.distortion.is_zero()) return;
  constexpr std::size_t kRows = 16;
  corners_ = {camera_.width_px + 1, camera_.height_px + 1, Eigen::Vector2f::Zero()};
  workers.for_chunks(static_cast<std::size_t>(corners_.height), kRows,
                     [&](std::size_t begin, std::size_t end) {
                       for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                         for (int x = 0; x < corners_.width; ++x) {
                           const Vector2d distorted = camera_.back_project(x - 0.5, y - 0.5, 1.0).head<2>();
                           corners_(x, y) = camera.distortion.undistort(distorted).cast<float>();
                         }
                       }
                     });
}

void RayField::row(int v, const Vector2d& offset_px, std::span<float> x, std::span<float> y) const {
  if (corners_.empty()) {
    const Vector3d first = camera_.back_project(offset_px.x(), v + offset_px.y(), 1.0);
    const double step = 1.0 / camera_.fx_px;
    for (std::size_t u = 0; u < x.size(); ++u) {
      x[u] = static_cast<float>(first.x() + step * static_cast<double>(u));
      y[u] = static_cast<float>(first.y());
    }
    return;
  }
  const Eigen::Vector2f f = (offset_px + Vector2d(0.5, 0.5)).cast<float>();
  const Eigen::Vector2f* above = &corners_(0, v);
  const Eigen::Vector2f* below = &corners_(0, v + 1);
  for (std::size_t u = 0; u < x.size(); ++u) {
    const Eigen::Vector2f top = above[u] + f.x() * (above[u + 1] - above[u]);
    const Eigen::Vector2f bottom = below[u] + f.x() * (below[u + 1] - below[u]);
    const Eigen::Vector2f direction = top + f.y() * (bottom - top);
    x[u] = direction.x();
    y[u] = direction.y();
  }
}

}  // namespace fusebench::simulator::rays
