#include "core/estimator/alignment/start_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/geometry.hpp"
#include "core/config/groups/alignment_config.hpp"
#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/residuals_config.hpp"
#include "core/estimator/filter/pose_clones.hpp"

namespace fusebench::alignment {

namespace {
constexpr double kLeastShare = 0.1;  // smallest share of the reference points that gives a valid comparison
}  // namespace

double landing_sigma_px(const filter::GaussianState& prior, const ReferencePoints& reference,
                        const SensorRig& rig) {
  if (reference.empty()) return 0;
  const Eigen::Matrix<double, filter::kPoseSize, filter::kStateSize> by_reference =
      filter::measured_combinations(prior.mean).topRows<filter::kPoseSize>();
  const Matrix6d covariance = by_reference * prior.covariance * by_reference.transpose();
  const patches::PosedCamera camera(rig.camera, prior.mean.T_world_imu, rig.T_imu_camera);
  const SE3 T_world_reference = prior.mean.T_world_imu_reference * rig.T_imu_camera;
  double sum = 0;
  int count = 0;
  for (const ReferencePoint& point : reference.level(reference.coarsest_level())) {
    const Vector3d in_camera = camera.to_camera(T_world_reference * point.point_camera);
    if (in_camera.z() < 0.1) continue;
    const Eigen::Matrix<double, 2, filter::kPoseSize> jacobian =
        camera.by_pose(camera.camera.projection_jacobian(in_camera), in_camera);
    const Eigen::Matrix2d spread = jacobian * covariance * jacobian.transpose();
    const double half_trace = 0.5 * spread.trace();
    sum += half_trace + std::sqrt(std::max(0.0, half_trace * half_trace - spread.determinant()));
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

StartSearch::StartSearch(const config::AlignmentConfig& alignment, int patch_levels,
                         const config::PhotometricConfig& photometric, const config::IekfConfig& iekf,
                         const SensorRig& rig)
    : config_(alignment),
      patch_levels_(patch_levels),
      iekf_(iekf),
      rig_(rig),
      alignment_(alignment, photometric, rig) {}

int StartSearch::coarsest_level(double sigma_px, const ReferencePoints& reference) const {
  const double distance_px = config_.reach_sigmas * sigma_px;
  const auto reach_px = [&](int level) { return config_.reach_px * (1 << level); };
  if (distance_px <= reach_px(patch_levels_ - 1)) return -1;
  int level = reference.finest_level();
  while (level < reference.coarsest_level() && distance_px > reach_px(level)) ++level;
  return level;
}

/// Candidate starts: constant motion and standstill. If the predicted uncertainty exceeds the convergence
/// radius of the coarsest level, also rotations by twice that radius to each side.
std::vector<filter::MeasuredVector> StartSearch::starts(const filter::GaussianState& prior,
                                                        const SE3& T_world_imu_last, double sigma_px,
                                                        const ReferencePoints& reference) const {
  std::vector<filter::MeasuredVector> starts = {filter::MeasuredVector::Zero(),
                                                filter::start_at(prior, T_world_imu_last)};
  const double reach_px = config_.reach_px * (1 << reference.coarsest_level());
  if (config_.reach_sigmas * sigma_px <= reach_px) return starts;
  const double step_rad = 2 * reach_px / rig_.camera.fx_px;
  for (const double about_x : {-step_rad, 0.0, step_rad}) {
    for (const double about_y : {-step_rad, 0.0, step_rad}) {
      if (about_x == 0 && about_y == 0) continue;
      const SE3 turned(so3_exp(Vector3d(about_x, about_y, 0)), Vector3d::Zero());
      starts.push_back(filter::start_at(
          prior, prior.mean.T_world_imu * rig_.T_imu_camera * turned * rig_.T_imu_camera.inverse()));
    }
  }
  return starts;
}

FoundStart StartSearch::find(const filter::GaussianState& prior, const SE3& T_world_imu_last,
                             const ReferencePoints& reference, std::span<const GreyImage> pyramid,
                             bool thorough) {
  FoundStart found;
  if (reference.empty()) return found;
  found.landing_sigma_px = landing_sigma_px(prior, reference, rig_);
  found.coarsest_level =
      thorough ? reference.coarsest_level() : coarsest_level(found.landing_sigma_px, reference);
  if (found.coarsest_level < 0) return found;
  config::IekfConfig iterations = iekf_;
  iterations.max_iterations = config_.max_iterations;
  const SE3 T_world_reference = prior.mean.T_world_imu_reference * rig_.T_imu_camera;
  double least = std::numeric_limits<double>::infinity();
  for (const filter::MeasuredVector& start :
       starts(prior, T_world_imu_last, found.landing_sigma_px, reference)) {
    alignment_.observe(pyramid, reference, T_world_reference, found.coarsest_level);
    const filter::IekfResult result = filter::iekf_update(prior, alignment_, iterations, start);
    // A start with fewer visible points has fewer residuals, so the cost is divided by the visible share.
    const double cost = result.map_cost_posterior / std::max(kLeastShare, alignment_.seen_share());
    if (!(cost < least)) continue;
    least = cost;
    found.start = result.solution;
  }
  return found;
}

}  // namespace fusebench::alignment
