#include "core/baselines/elasticfusion/tracking/rotation_start.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace fusebench::baselines::elasticfusion::tracking {

namespace {

constexpr int kMostSteps = 10;
constexpr double kLeastOverlap = 0.2;  // as a share of the pixels

struct RotationSums {
  Matrix3d information = Matrix3d::Zero();
  Vector3d descent = Vector3d::Zero();
  double cost = 0;
  double pixels = 0;
};

RotationSums sums_at(const LiveLevel& before, const LiveLevel& now, const Quaterniond& R_before_now) {
  RotationSums sums;
  const Matrix3d R = R_before_now.toRotationMatrix();
  for (int y = 0; y < now.camera.height_px; ++y) {
    for (int x = 0; x < now.camera.width_px; ++x) {
      const Vector3d ray = R * now.camera.back_project(x, y, 1.0);
      if (!(ray.z() > 0)) continue;
      const Vector2d at = now.camera.project(ray);
      if (!(at.x() >= 0) || !(at.y() >= 0) || !(at.x() <= before.intensity.width - 1) ||
          !(at.y() <= before.intensity.height - 1))
        continue;
      const std::size_t pixel = now.intensity.index(x, y);
      const std::size_t pixel_before = before.intensity.index(static_cast<int>(std::lround(at.x())),
                                                              static_cast<int>(std::lround(at.y())));
      const double residual = static_cast<double>(now.intensity.data[pixel]) -
                              sample_bilinear(before.intensity, at.x(), at.y()).value;
      const Eigen::Vector2f mean_gradient =
          0.5F * Eigen::Vector2f(before.gradient.dx.data[pixel_before] + now.gradient.dx.data[pixel],
                                 before.gradient.dy.data[pixel_before] + now.gradient.dy.data[pixel]);
      const Vector3d slope = now.camera.projection_jacobian(ray).transpose() * mean_gradient.cast<double>();
      const Vector3d direction = ray.cross(slope);
      sums.information += direction * direction.transpose();
      sums.descent += residual * direction;
      sums.cost += residual * residual;
      sums.pixels += 1;
    }
  }
  return sums;
}

}  // namespace

Quaterniond rotation_between(const LiveLevel& before, const LiveLevel& now) {
  Quaterniond rotation = Quaterniond::Identity(), best = rotation;
  double best_mean = std::numeric_limits<double>::infinity();
  const double fewest = kLeastOverlap * static_cast<double>(now.intensity.data.size());
  for (int step = 0; step <= kMostSteps; ++step) {
    const RotationSums sums = sums_at(before, now, rotation);
    if (sums.pixels < fewest || !(sums.cost / sums.pixels < best_mean)) break;
    best_mean = sums.cost / sums.pixels;
    best = rotation;
    const Eigen::LLT<Matrix3d> factor(sums.information);
    if (factor.info() != Eigen::Success) break;
    const Vector3d turn = factor.solve(sums.descent);
    if (!turn.allFinite()) break;
    rotation = (so3_exp(turn) * rotation).normalized();
  }
  return best;
}

}  // namespace fusebench::baselines::elasticfusion::tracking
