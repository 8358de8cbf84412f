#include "core/baselines/elasticfusion/surfels/seen_surface.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::baselines::elasticfusion::surfels {

namespace {

constexpr float kFreeSpace_m = 0.01F;
constexpr float kLeastFacing = 0.85F;  // of the normal along the optical axis
constexpr int kFewestBehind = 2;

}  // namespace

SeenSurface::SeenSurface(const PinholeCamera& camera)
    : camera_(camera),
      nearest_m_(camera.width_px, camera.height_px),
      measurements_(camera.width_px, camera.height_px) {}

/// The nearest pixel; false if it is outside the image.
bool SeenSurface::place(const Eigen::Vector3f& point_camera, int& x, int& y) const {
  const Vector2d at = camera_.project(point_camera.cast<double>());
  if (!(at.x() > -0.5) || !(at.y() > -0.5)) return false;
  x = static_cast<int>(at.x() + 0.5);
  y = static_cast<int>(at.y() + 0.5);
  return nearest_m_.contains(x, y);
}

void SeenSurface::add(const Eigen::Vector3f& point_camera) {
  int x = 0, y = 0;
  if (!place(point_camera, x, y)) return;
  float& nearest_m = nearest_m_(x, y);
  if (nearest_m == 0 || point_camera.z() < nearest_m) nearest_m = point_camera.z();
  std::uint8_t& count = measurements_(x, y);
  if (count < 255) ++count;
}

bool SeenSurface::is_behind(const Eigen::Vector3f& point_camera, const Eigen::Vector3f& normal_camera) const {
  if (std::abs(normal_camera.z()) < kLeastFacing) return false;
  int x = 0, y = 0;
  if (!place(point_camera, x, y)) return false;
  int behind = 0;
  for (int v = std::max(0, y - 1); v <= std::min(nearest_m_.height - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(nearest_m_.width - 1, x + 1); ++u) {
      if (measurements_(u, v) == 0) continue;
      if (nearest_m_(u, v) <= point_camera.z() + kFreeSpace_m) return false;
      behind += measurements_(u, v);
    }
  }
  return behind >= kFewestBehind;
}

}  // namespace fusebench::baselines::elasticfusion::surfels
