#include "datasets/calibration/camera_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"

namespace fusebench::calibration {

namespace {

/// distort() and its derivative, which Newton's method needs.
struct DistortedPoint {
  Vector2d point;
  Eigen::Matrix2d derivative;
};

DistortedPoint distort_with_derivative(const BrownConrady& c, const Vector2d& ideal) {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double radial_by_r2 = c.k1 + r2 * (2 * c.k2 + r2 * 3 * c.k3);
  DistortedPoint d;
  d.point = {x * radial + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x),
             y * radial + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y};
  const double mixed = 2 * x * y * radial_by_r2 + 2 * c.p1 * x + 2 * c.p2 * y;  // the derivative is symmetric
  d.derivative << radial + 2 * x * x * radial_by_r2 + 2 * c.p1 * y + 6 * c.p2 * x, mixed,  //
      mixed, radial + 2 * y * y * radial_by_r2 + 6 * c.p1 * y + 2 * c.p2 * x;
  return d;
}

}  // namespace

Vector2d BrownConrady::distort(const Vector2d& ideal) const {
  return distort_with_derivative(*this, ideal).point;
}

Vector2d BrownConrady::undistort(const Vector2d& distorted) const {
  constexpr int kMaxIterations = 20;  // 3 to 5 suffice for the calibrations in use
  constexpr double kTolerance = 1e-14;
  Vector2d ideal = distorted;
  for (int i = 0; i < kMaxIterations; ++i) {
    const DistortedPoint d = distort_with_derivative(*this, ideal);
    const Vector2d step = d.derivative.inverse() * (distorted - d.point);
    ideal += step;
    if (step.norm() < kTolerance) break;
  }
  return ideal;
}

Undistortion::Undistortion(const CalibratedCamera& camera)
    : camera_(camera.pinhole), identity_(camera.distortion.is_zero()) {
  const int width = camera_.width_px;
  const int height = camera_.height_px;
  check(width > 0 && height > 0, "undistortion needs the size of the images");
  if (identity_) return;
  color_ = BilinearMap(width, height);
  nearest_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vector3d ray = camera_.back_project(x, y, 1.0);
      const Vector2d distorted = camera.distortion.distort(ray.head<2>());
      // Far outside would overflow; there, the border is used.
      const double u = std::clamp(camera_.fx_px * distorted.x() + camera_.cx_px, -2.0, width + 1.0);
      const double v = std::clamp(camera_.fy_px * distorted.y() + camera_.cy_px, -2.0, height + 1.0);
      color_.add(static_cast<std::int32_t>(std::lround(u * BilinearMap::kFractions)),
                 static_cast<std::int32_t>(std::lround(v * BilinearMap::kFractions)));
      const auto nearest_x = static_cast<int>(std::lround(u));
      const auto nearest_y = static_cast<int>(std::lround(v));
      const bool inside = nearest_x >= 0 && nearest_y >= 0 && nearest_x < width && nearest_y < height;
      nearest_.push_back(inside ? nearest_y * width + nearest_x : -1);
    }
  }
}

ColorImage Undistortion::undistort_color(const ColorImage& distorted) const {
  check(distorted.width == camera_.width_px && distorted.height == camera_.height_px,
        "the image has the size of its camera");
  return identity_ ? distorted : color_.apply(distorted);
}

DepthImage Undistortion::undistort_depth(const DepthImage& distorted_m) const {
  check(distorted_m.width == camera_.width_px && distorted_m.height == camera_.height_px,
        "the image has the size of its camera");
  if (identity_) return distorted_m;
  DepthImage result(distorted_m.width, distorted_m.height);
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    if (nearest_[i] >= 0) result.data[i] = distorted_m.data[static_cast<std::size_t>(nearest_[i])];
  }
  return result;
}

}  // namespace fusebench::calibration
