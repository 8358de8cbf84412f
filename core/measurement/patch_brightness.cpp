#include "core/measurement/patch_brightness.hpp"

#include <Eigen/LU>

#include "core/config/groups/residuals_config.hpp"

namespace fusebench::measurement {

namespace {

/// Information of a prior with that standard deviation; zero sigma fixes the value.
double prior_information(double sigma) { return sigma > 0 ? 1.0 / (sigma * sigma) : 1e18; }

}  // namespace

void PatchBrightness::try_step(const Eigen::Matrix<double, filter::kPoseSize, 1>& pose_step,
                               double fraction) {
  const Vector2d step = -information.inverse() * (gradient + by_pose * pose_step);
  trial = value + fraction * step;
}

BrightnessPrior::BrightnessPrior(const config::PhotometricConfig& config)
    : information_(prior_information(config.gain_sigma), prior_information(config.offset_sigma_grey)) {}

double BrightnessPrior::cost(const Vector2d& gain_and_offset) const {
  const double gain = gain_and_offset.x() - 1.0;
  const double offset = gain_and_offset.y();
  return 0.5 * (gain * gain * information_.x() + offset * offset * information_.y());
}

void BrightnessPrior::eliminate(PatchBrightness& light, filter::PoseQuadratic& photometric) const {
  light.information += information_.asDiagonal().toDenseMatrix();
  light.gradient += information_.cwiseProduct(light.value - Vector2d(1.0, 0.0));
  photometric.cost += cost(light.value);
  const Eigen::Matrix2d inverse = light.information.inverse();
  photometric.information -= light.by_pose.transpose() * inverse * light.by_pose;
  photometric.gradient -= light.by_pose.transpose() * inverse * light.gradient;
}

}  // namespace fusebench::measurement
