#include "core/systems/elasticfusion/tracking/rotation_start.hpp"

#include <Eigen/Cholesky>
#include <limits>

namespace fusebench::systems::elasticfusion::tracking {

namespace {

constexpr int kMostSteps = 10;
constexpr double kLeastOverlap = 0.2;  // share of the pixels

struct RotationSums {
  Matrix3d information = Matrix3d::Zero();
  Vector3d descent = Vector3d::Zero();
  double cost = 0;
  double pixels = 0;
};

RotationSums sums_at(const GreyImage& before, const GreyImage& now, const PinholeCamera& camera,
                     const Quaterniond& R_before_now) {
  RotationSums sums;
  const Matrix3d R = R_before_now.toRotationMatrix();
  for (int y = 0; y < now.height; ++y) {
    for (int x = 0; x < now.width; ++x) {
      const Vector3d ray = R * camera.back_project(x, y, 1.0);
      if (!(ray.z() > 0)) continue;
      const Vector2d at = camera.project(ray);
      if (!(at.x() >= 0) || !(at.y() >= 0) || !(at.x() <= before.width - 1) || !(at.y() <= before.height - 1))
        continue;
      const IntensitySample sample = sample_bilinear(before, at.x(), at.y());
      const double residual = static_cast<double>(now(x, y)) - sample.value;
      const Vector3d slope = camera.projection_jacobian(ray).transpose() * Vector2d(sample.dx, sample.dy);
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

Quaterniond rotation_between(const GreyImage& before, const GreyImage& now, const PinholeCamera& camera) {
  Quaterniond rotation = Quaterniond::Identity(), best = rotation;
  double best_mean = std::numeric_limits<double>::infinity();
  const double fewest = kLeastOverlap * static_cast<double>(now.data.size());
  for (int step = 0; step <= kMostSteps; ++step) {
    const RotationSums sums = sums_at(before, now, camera, rotation);
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

}  // namespace fusebench::systems::elasticfusion::tracking
