#include "core/systems/bundlefusion/dense_verification.hpp"

namespace fusebench::systems::bundlefusion {

namespace {

/// What points of b show in the image of a.
bool fits_into(const DepthCloud& a, const DepthCloud& b, const SE3& T_a_b, const DenseLimits& limits) {
  const Eigen::Matrix3f R = T_a_b.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = T_a_b.translation.cast<float>();
  std::size_t matched = 0;
  std::size_t compared = 0;
  double error_sum_m = 0;
  for (std::size_t i = 0; i < b.points.data.size(); ++i) {
    if (b.normals.data[i].isZero(0)) continue;
    const Eigen::Vector3f point = R * b.points.data[i] + t;
    const auto cell = a.cell_at(point);
    if (!cell) continue;
    const Eigen::Vector3f& surface = a.points.data[*cell];
    if (are_of_one_surface(surface, a.normals.data[*cell], point, R * b.normals.data[i])) {
      error_sum_m += static_cast<double>((surface - point).norm());
      ++matched;
      ++compared;
    } else if (point.z() < surface.z()) {
      error_sum_m += static_cast<double>(surface.z() - point.z());
      ++compared;
    }
  }
  const auto cells = static_cast<double>(b.points.data.size());
  return matched > 0 && static_cast<double>(matched) >= limits.min_overlap_share * cells &&
         error_sum_m <= limits.max_error_m * static_cast<double>(compared);
}

}  // namespace

bool fit_together(const DepthCloud& a, const DepthCloud& b, const SE3& T_a_b, const DenseLimits& limits) {
  return fits_into(a, b, T_a_b, limits) && fits_into(b, a, T_a_b.inverse(), limits);
}

}  // namespace fusebench::systems::bundlefusion
