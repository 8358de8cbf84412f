#include "core/relocalisation/place_certainty.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fusebench::relocalisation {

namespace {

constexpr double kMinInlierShare = 0.3;
constexpr int kMinCells = 5;
// Standard deviation of the position as a share of the distance of what is seen.
constexpr double kMaxRelativeSigma = 0.015;
constexpr int kSpreadCells = 4;  // a side

/// Cells of a grid over the image in which inliers are.
int occupied_cells(std::span<const SeenPoint> seen, const std::vector<std::size_t>& inliers,
                   const PinholeCamera& camera) {
  std::array<bool, kSpreadCells * kSpreadCells> occupied{};
  for (const std::size_t i : inliers) {
    const Vector2d& p = seen[i].pixel_px;
    const int column =
        std::clamp(static_cast<int>(p.x() * kSpreadCells / camera.width_px), 0, kSpreadCells - 1);
    const int row =
        std::clamp(static_cast<int>(p.y() * kSpreadCells / camera.height_px), 0, kSpreadCells - 1);
    occupied[static_cast<std::size_t>(row * kSpreadCells + column)] = true;
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
                      const PinholeCamera& camera) {
  const auto inliers = static_cast<double>(pose.inliers.size());
  const double position_sigma_m = std::sqrt(pose.covariance.bottomRightCorner<3, 3>().trace());
  return pose.inliers.size() >= kMinPlaceInliers &&
         inliers >= kMinInlierShare * static_cast<double>(seen.size()) &&
         occupied_cells(seen, pose.inliers, camera) >= kMinCells &&
         position_sigma_m <= kMaxRelativeSigma * mean_distance_m(seen, pose);
}

}  // namespace fusebench::relocalisation
