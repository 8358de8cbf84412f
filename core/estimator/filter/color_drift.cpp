#include "core/estimator/filter/color_drift.hpp"

#include <algorithm>
#include <cmath>

#include "core/config/groups/filter_config.hpp"

namespace fusebench::filter {

void ColorDrift::observe(const Vector6d& correction_imu, const config::ColorDriftConfig& config) {
  if (corrections_.size() < static_cast<std::size_t>(config.lag_frames)) {
    corrections_.push_back(correction_imu);
    return;
  }
  Vector6d& before = corrections_[oldest_];
  const double share = 1.0 / config.memory_frames;
  const auto follow = [share](double& covariance, double product) {
    covariance += share * (product / 3.0 - covariance);
  };
  follow(rotation_covariance_rad2_, before.head<3>().dot(correction_imu.head<3>()));
  follow(translation_covariance_m2_, before.tail<3>().dot(correction_imu.tail<3>()));
  before = correction_imu;
  oldest_ = (oldest_ + 1) % corrections_.size();
}

ReferenceNoise ColorDrift::noise(const config::ColorDriftConfig& config) const {
  return {config.factor * std::sqrt(std::max(0.0, rotation_covariance_rad2_)),
          config.factor * std::sqrt(std::max(0.0, translation_covariance_m2_))};
}

}  // namespace fusebench::filter
