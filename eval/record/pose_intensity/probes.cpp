#include "eval/record/pose_intensity/probes.hpp"

#include <algorithm>
#include <cmath>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/estimator/patches/corner_selection.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::pose_intensity {

Vector2d landed_px(const PinholeCamera& camera, const SE3& T_now_before, const Vector3d& point) {
  constexpr double kLeastDepth_m = 0.05;  // a pose that puts a point behind the camera is wrong enough
  Vector3d now = T_now_before * point;
  now.z() = std::max(now.z(), kLeastDepth_m);
  return camera.project(now);
}

std::vector<Probe> probes_of(const GreyImage& grey, const DepthImage& depth_m, const PinholeCamera& camera,
                             const config::PatchConfig& patches, const DepthImage* true_depth_m) {
  std::vector<Probe> probes;
  const DepthImage& used_m = true_depth_m == nullptr ? depth_m : *true_depth_m;
  for (const Eigen::Vector2i& centre : patches::select_corners(grey, depth_m, {}, patches)) {
    const std::size_t begin = probes.size();
    const Eigen::Vector2i corner = centre.array() - patches.size_px / 2;
    for (int y = corner.y(); y < corner.y() + patches.size_px; ++y) {
      for (int x = corner.x(); x < corner.x() + patches.size_px; ++x) {
        const auto z_m = static_cast<double>(used_m(x, y));
        if (z_m > 0) probes.push_back({camera.back_project(x, y, z_m), static_cast<double>(grey(x, y))});
      }
    }
    if (probes.size() - begin < static_cast<std::size_t>(patches.min_valid_px)) probes.resize(begin);
  }
  return probes;
}

bool is_seen(const Vector3d& point_now, const PinholeCamera& camera, const DepthImage& depth_m,
             const config::PatchConfig& patches, const config::DepthConfig& depth) {
  if (!(point_now.z() > 0)) return false;
  const Vector2d at = camera.project(point_now);
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() <= depth_m.width - 1 && at.y() <= depth_m.height - 1))
    return false;
  const auto measured_m = static_cast<double>(
      depth_m(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y()))));
  if (!(measured_m > 0)) return true;
  const double tolerance_m =
      std::max(patches.occlusion_distance_m, 3 * preprocessing::depth_sigma_m(measured_m, depth));
  return std::abs(point_now.z() - measured_m) <= tolerance_m;
}

DepthImage true_depth_m(const simulator::rays::RayCaster& scene, const PinholeCamera& camera,
                        const SE3& T_truth_camera) {
  DepthImage depth_m(camera.width_px, camera.height_px, 0);
  const auto width = static_cast<std::size_t>(camera.width_px);
  std::vector<float> x(width), y(width), z(width);
  std::vector<simulator::rays::RayHit> hits(width);
  const Matrix3d R_truth_camera = T_truth_camera.rotation_matrix();
  for (int v = 0; v < camera.height_px; ++v) {
    for (std::size_t u = 0; u < width; ++u) {
      // Directions of depth 1, so that the length of a hit is its depth.
      const Vector3d ray = R_truth_camera * camera.back_project(static_cast<double>(u), v, 1.0);
      x[u] = static_cast<float>(ray.x());
      y[u] = static_cast<float>(ray.y());
      z[u] = static_cast<float>(ray.z());
    }
    scene.cast(T_truth_camera.translation.cast<float>(), x, y, z, hits);
    for (std::size_t u = 0; u < width; ++u) {
      if (hits[u].triangle != simulator::rays::RayHit::kNothing)
        depth_m(static_cast<int>(u), v) = hits[u].distance;
    }
  }
  return depth_m;
}

}  // namespace fusebench::pose_intensity
