#include "core/estimator/places/place_certainty.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/config/groups/relocalisation_config.hpp"

namespace fusebench::places {

namespace {

/// Number of cells of an image grid with inliers.
int occupied_cells(std::span<const SeenPoint> seen, const std::vector<std::size_t>& inliers,
                   const PinholeCamera& camera, int cells_per_side) {
  std::vector<bool> occupied(static_cast<std::size_t>(cells_per_side * cells_per_side));
  for (const std::size_t i : inliers) {
    const Vector2d& p = seen[i].pixel_px;
    const int column =
        std::clamp(static_cast<int>(p.x() * cells_per_side / camera.width_px), 0, cells_per_side - 1);
    const int row =
        std::clamp(static_cast<int>(p.y() * cells_per_side / camera.height_px), 0, cells_per_side - 1);
    occupied[static_cast<std::size_t>(row * cells_per_side + column)] = true;
  }
  return static_cast<int>(std::count(occupied.begin(), occupied.end(), true));
}

double mean_distance_m(std::span<const SeenPoint> seen, const PoseFromPoints& pose) {
  const SE3 T_camera_a = pose.T_a_camera.inverse();
  double sum_m = 0;
  for (const std::size_t i : pose.inliers) sum_m += (T_camera_a * seen[i].point_a).z();
  return sum_m / static_cast<double>(pose.inliers.size());
}

}  // namespace

bool is_certain_place(std::span<const SeenPoint> seen, const PoseFromPoints& pose,
                      const PinholeCamera& camera, const config::RelocalisationConfig& config) {
  const auto inliers = static_cast<double>(pose.inliers.size());
  const double position_sigma_m = std::sqrt(pose.covariance.bottomRightCorner<3, 3>().trace());
  return pose.inliers.size() >= static_cast<std::size_t>(config.min_inliers) &&
         inliers >= config.min_inlier_share * static_cast<double>(seen.size()) &&
         occupied_cells(seen, pose.inliers, camera, config.spread_cells_per_side) >=
             config.min_spread_cells &&
         position_sigma_m <= config.max_relative_position_sigma * mean_distance_m(seen, pose);
}

}  // namespace fusebench::places
