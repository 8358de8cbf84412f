#include "core/baselines/elasticfusion/tracking/camera_tracker.hpp"

#include <cmath>
#include <limits>

#include "core/base/solvers.hpp"
#include "core/baselines/elasticfusion/tracking/intensity_matching.hpp"
#include "core/baselines/elasticfusion/tracking/plane_matching.hpp"
#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::elasticfusion::tracking {

namespace {

constexpr std::array<int, kLevels> kSteps = {10, 5, 4};
constexpr std::array<double, kLevels> kMinGradient = {5, 3, 1};
constexpr double kLongestStep_m = 0.3;

double mean_square(const PoseSums& sums) { return sums.pixels > 0 ? sums.cost / sums.pixels : 0; }

}  // namespace

double TrackedMotion::variance() const {
  const Eigen::FullPivLU<Matrix6d> factor(images.information);
  if (!factor.isInvertible()) return std::numeric_limits<double>::infinity();
  return factor.inverse().diagonal().maxCoeff();
}

TrackedMotion CameraTracker::track(const LivePyramid& live, const ViewPyramid& view, const SE3& T_view_start,
                                   const PoseTerm* term) const {
  TrackedMotion motion;
  motion.T_view_camera = T_view_start;
  const double weight = config_.icp_weight;
  // The published program weights the gradient of the planes once and their information twice.
  const double pull = config_.defects == config::PeerDefects::as_published ? weight : weight * weight;
  for (int number = kLevels - 1; number >= 0; --number) {
    const auto level = static_cast<std::size_t>(number);
    const auto pixels = telling_pixels(live[level], kMinGradient[level]);
    for (int step = 0; step < kSteps[level]; ++step) {
      const PoseSums planes = match_planes(live[level], view[level], motion.T_view_camera, workers_);
      const PoseSums intensities =
          match_intensities(pixels, view[level], motion.T_view_camera, config_.defects, workers_);
      const Matrix6d plane_information = weight * weight * planes.information;
      ImageEquations& images = motion.images;
      images.information = intensities.information + plane_information;
      images.descent = intensities.descent + pull * planes.descent;
      images.scatter = mean_square(intensities) * intensities.information +
                       weight * weight * mean_square(planes) * plane_information;
      motion.matches = planes.pixels;
      motion.error_m = planes.pixels > 0 ? std::sqrt(planes.cost) / planes.pixels : 0;
      const Vector6d change = term != nullptr ? term->step(motion.T_view_camera, images)
                                              : Vector6d(images.information.ldlt().solve(images.descent));
      if (!change.allFinite()) continue;
      motion.T_view_camera = SE3{so3_exp(change.head<3>()), change.tail<3>()} * motion.T_view_camera;
    }
  }
  if (motion.T_view_camera.translation.norm() > kLongestStep_m) {
    motion.T_view_camera = SE3{};
    motion.was_dropped = true;
  }
  return motion;
}

}  // namespace fusebench::baselines::elasticfusion::tracking
