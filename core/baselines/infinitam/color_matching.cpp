#include "core/baselines/infinitam/color_matching.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/baselines/image_rows.hpp"

namespace fusebench::baselines::infinitam {

namespace {

double bilinear(const Image<float>& image, double x, double y) {
  const auto left = static_cast<int>(x), top = static_cast<int>(y);
  const double dx = x - left, dy = y - top;
  const auto at = [&](int u, int v) { return static_cast<double>(image(u, v)); };
  return (1 - dx) * (1 - dy) * at(left, top) + dx * (1 - dy) * at(left + 1, top) +
         (1 - dx) * dy * at(left, top + 1) + dx * dy * at(left + 1, top + 1);
}

/// Tukey's norm of a residual with its derivative and the approximate second derivative of the published
/// program.
struct TukeyNorm {
  double cost, first, second;

  TukeyNorm(double residual, double width) : cost(width * width / 6), first(0), second(0) {
    if (std::abs(residual) > width) return;
    const double left = 1 - (residual / width) * (residual / width);
    cost *= 1 - left * left * left;
    first = residual * left * left;
    second = std::abs(residual) < width ? 1 : 0;
  }
};

void add_pixel(const ColorLevel& level, int x, int y, const SE3& T_world_camera, const SE3& T_before_world,
               const ColorMatching& matching, PoseSums& sums) {
  const auto depth_m = static_cast<double>((*level.depth_m)(x, y));
  constexpr double kLeast_m = 1e-3;
  if (!(depth_m >= kLeast_m) || depth_m > matching.far_m) return;
  const Vector3d point = T_world_camera * level.camera.back_project(x, y, depth_m);
  const Vector3d seen = T_before_world * point;
  if (!(seen.z() > 0)) return;
  const Vector2d at = level.camera.project(seen);
  const Image<float>& before = *level.before;
  if (!(at.x() >= 0) || !(at.y() >= 0) || at.x() >= before.width - 1 || at.y() >= before.height - 1) return;
  const double residual = bilinear(before, at.x(), at.y()) - static_cast<double>((*level.intensity)(x, y));
  if (std::abs(residual) >= matching.max_difference) return;
  const Vector2d gradient(bilinear(*level.before_dx, at.x(), at.y()),
                          bilinear(*level.before_dy, at.x(), at.y()));
  if (gradient.cwiseAbs().minCoeff() < matching.min_gradient) return;
  const Vector3d by_point =
      T_before_world.rotation.conjugate() * (level.camera.projection_jacobian(seen).transpose() * gradient);
  Vector6d slope;
  slope << point.cross(by_point), by_point;
  const double left = std::max(0.0, 1 - (depth_m - matching.near_m) / (matching.far_m - matching.near_m));
  const TukeyNorm norm(residual, matching.tukey);
  sums.information += left * left * norm.second * slope * slope.transpose();
  sums.descent -= left * left * norm.first * slope;
  sums.cost += left * left * norm.cost;
  sums.pixels += 1;
}

}  // namespace

PoseSums match_color(const ColorLevel& level, const SE3& T_world_camera, const SE3& T_world_before,
                     const ColorMatching& matching, const Workers& workers) {
  const SE3 T_before_world = T_world_before.inverse();
  const auto rows = [&](std::size_t begin, std::size_t end) {
    PoseSums sums;
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < level.depth_m->width; ++x)
        add_pixel(level, x, y, T_world_camera, T_before_world, matching, sums);
    }
    return sums;
  };
  PoseSums sums;
  for (const PoseSums& part :
       workers.map_chunks<PoseSums>(static_cast<std::size_t>(level.depth_m->height), kRowsASum, rows))
    sums += part;
  return sums;
}

}  // namespace fusebench::baselines::infinitam
