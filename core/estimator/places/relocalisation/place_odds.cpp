#include "core/estimator/places/relocalisation/place_odds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/solvers.hpp"
#include "core/config/groups/relocalisation_config.hpp"

namespace fusebench::relocalisation {

namespace {

constexpr double kDegreesOfFreedom = 3;  // of the Student t distribution
constexpr double kElsewhere = 2;         // in units of the keyframes' spacing

/// Normalisation of the t distribution in k = 6 dimensions: Gamma((nu + k) / 2) / (Gamma(nu / 2) (nu pi)^(k /
/// 2)).
double normalisation() {
  constexpr double kSize = filter::kPoseSize;
  return std::exp(std::lgamma(0.5 * (kDegreesOfFreedom + kSize)) - std::lgamma(0.5 * kDegreesOfFreedom)) /
         std::pow(kDegreesOfFreedom * std::numbers::pi, 0.5 * kSize);
}

RelocalisedPose shifted(const RelocalisedPose& place, const Vector3d& offset_world_m) {
  RelocalisedPose there = place;
  there.T_world_imu.translation += offset_world_m;
  return there;
}

}  // namespace

double pose_density(const filter::GaussianState& prediction, const RelocalisedPose& place) {
  const Vector6d innovation = pose_minus(place.T_world_imu, prediction.mean.T_world_imu);
  const Eigen::LDLT<Matrix6d> covariance(innovation_covariance(prediction, place));
  const double chi2 = innovation.dot(covariance.solve(innovation));
  const double determinant = covariance.vectorD().prod();
  return normalisation() / std::sqrt(determinant) *
         std::pow(1 + chi2 / kDegreesOfFreedom, -0.5 * (kDegreesOfFreedom + filter::kPoseSize));
}

bool are_elsewhere(const SE3& T_world_a, const SE3& T_world_b, const config::RelocalisationConfig& config) {
  return (T_world_a.translation - T_world_b.translation).norm() > kElsewhere * config.keyframe_distance_m ||
         rotation_angle_rad(T_world_a.rotation, T_world_b.rotation) >
             kElsewhere * radians(config.keyframe_angle_deg);
}

void PlaceOdds::measure_spacing(std::span<const RelocalisedPose> candidates) {
  // In a room with two similar sides, only the direction differs.
  const double least_m = kElsewhere * config_.keyframe_distance_m;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (std::size_t j = i + 1; j < candidates.size(); ++j) {
      const SE3& a = candidates[i].T_world_imu;
      const SE3& b = candidates[j].T_world_imu;
      if (!are_elsewhere(a, b, config_)) continue;
      const double apart_m = std::max((a.translation - b.translation).norm(), least_m);
      spacing_m_ = std::min(apart_m, spacing_m_.value_or(apart_m));
    }
  }
}

/// Density of the most likely pose at that distance from the place: towards the prediction and beyond it, or
/// along the least certain axis of dead reckoning.
double PlaceOdds::density_at_spacing(const RelocalisedPose& place,
                                     const filter::GaussianState& prediction) const {
  if (!spacing_m_) return 0;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(
      prediction.covariance.block<3, 3>(filter::kPosition, filter::kPosition));
  const Vector3d loose = *spacing_m_ * axes.eigenvectors().col(2);
  double density = std::max(pose_density(prediction, shifted(place, loose)),
                            pose_density(prediction, shifted(place, -loose)));
  const Vector3d towards_m = prediction.mean.T_world_imu.translation - place.T_world_imu.translation;
  if (towards_m.norm() > 0)
    density =
        std::max(density, pose_density(prediction, shifted(place, *spacing_m_ * towards_m.normalized())));
  return density;
}

std::optional<std::size_t> PlaceOdds::decide(std::span<const RelocalisedPose> candidates,
                                             const filter::GaussianState& prediction) {
  if (candidates.empty()) return std::nullopt;
  measure_spacing(candidates);
  std::vector<double> densities;
  for (const RelocalisedPose& candidate : candidates)
    densities.push_back(pose_density(prediction, candidate));
  const auto likeliest = static_cast<std::size_t>(std::ranges::max_element(densities) - densities.begin());
  std::optional<std::size_t> first;
  double others = config_.lookalike_density + density_at_spacing(candidates[likeliest], prediction);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (are_elsewhere(candidates[i].T_world_imu, candidates[likeliest].T_world_imu, config_)) {
      others += densities[i];
    } else if (!first) {
      first = i;
    }
  }
  // Written so that NaN is rejected too.
  if (!(densities[likeliest] >= config_.min_odds * others)) return std::nullopt;
  return first;
}

}  // namespace fusebench::relocalisation
