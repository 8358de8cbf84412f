#include "datasets/camera_model.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"

namespace fusebench {

namespace {

// OpenCV's fixed-point maps count 1/32 pixels.
constexpr int kFractionBits = cv::INTER_BITS;
constexpr int kFractions = cv::INTER_TAB_SIZE;

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
  source_pixel_ = {width, height};
  source_fraction_ = {width, height};
  nearest_.assign(source_pixel_.data.size(), -1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vector3d ray = camera_.back_project(x, y, 1.0);
      const Vector2d distorted = camera.distortion.distort(ray.head<2>());
      // Coordinates far outside would overflow the 16-bit map; the border is replicated, so clamping changes
      // nothing.
      const double u = std::clamp(camera_.fx_px * distorted.x() + camera_.cx_px, -2.0, width + 1.0);
      const double v = std::clamp(camera_.fy_px * distorted.y() + camera_.cy_px, -2.0, height + 1.0);
      const long u32 = std::lround(u * kFractions);
      const long v32 = std::lround(v * kFractions);
      // >> and & floor and wrap also below zero.
      source_pixel_(x, y) = {static_cast<std::int16_t>(u32 >> kFractionBits),
                             static_cast<std::int16_t>(v32 >> kFractionBits)};
      source_fraction_(x, y) =
          static_cast<std::uint16_t>((v32 & (kFractions - 1)) * kFractions + (u32 & (kFractions - 1)));
      const auto nearest_x = static_cast<int>(std::lround(u));
      const auto nearest_y = static_cast<int>(std::lround(v));
      if (source_pixel_.contains(nearest_x, nearest_y)) {
        nearest_[source_pixel_.index(x, y)] =
            static_cast<std::int32_t>(source_pixel_.index(nearest_x, nearest_y));
      }
    }
  }
}

ColorImage Undistortion::undistort_color(const ColorImage& distorted) const {
  check(distorted.width == camera_.width_px && distorted.height == camera_.height_px,
        "the image has the size of its camera");
  if (identity_) return distorted;
  ColorImage result(distorted.width, distorted.height);
  // cv::Mat has no view of constant data; remap() does not write to its source and maps.
  const auto view = [&](int type, const void* data) {
    return cv::Mat(distorted.height, distorted.width, type, const_cast<void*>(data));
  };
  const cv::Mat source = view(CV_8UC3, distorted.data.data());
  cv::Mat target = view(CV_8UC3, result.data.data());
  cv::remap(source, target, view(CV_16SC2, source_pixel_.data.data()),
            view(CV_16UC1, source_fraction_.data.data()), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return result;
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

}  // namespace fusebench
