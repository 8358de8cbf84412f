#include "core/baselines/bundlefusion/dense_verification.hpp"

namespace fusebench::baselines::bundlefusion {

namespace {

/// Tests the points of b in the image of a.
bool fits_into(const DepthCloud& a, const DepthCloud& b, const SE3& T_a_b, const DenseLimits& limits) {
  std::size_t matched = 0;
  std::size_t compared = 0;
  double error_sum_m = 0;
  for_each_overlap(a, b, T_a_b,
                   [&](std::size_t cell, const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
                     const Eigen::Vector3f& surface = a.points.data[cell];
                     if (are_of_one_surface(surface, a.normals.data[cell], point, normal)) {
                       error_sum_m += static_cast<double>((surface - point).norm());
                       ++matched;
                       ++compared;
                     } else if (point.z() < surface.z()) {
                       error_sum_m += static_cast<double>(surface.z() - point.z());
                       ++compared;
                     }
                   });
  const auto cells = static_cast<double>(b.points.data.size());
  return matched > 0 && static_cast<double>(matched) >= limits.min_overlap_share * cells &&
         error_sum_m <= limits.max_error_m * static_cast<double>(compared);
}

}  // namespace

bool fit_together(const DepthCloud& a, const DepthCloud& b, const SE3& T_a_b, const DenseLimits& limits) {
  return fits_into(a, b, T_a_b, limits) && fits_into(b, a, T_a_b.inverse(), limits);
}

}  // namespace fusebench::baselines::bundlefusion
