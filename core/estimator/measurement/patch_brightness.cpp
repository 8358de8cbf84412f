#include "core/estimator/measurement/patch_brightness.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/upper_median.hpp"
#include "core/config/groups/residuals_config.hpp"
#include "core/estimator/measurement/patch_outcome.hpp"

namespace fusebench::measurement {

namespace {

/// Information of a prior with that standard deviation; a sigma of zero fixes the value.
double prior_information(double sigma) { return sigma > 0 ? 1.0 / (sigma * sigma) : 1e18; }

}  // namespace

void PatchBrightness::try_step(const Eigen::Matrix<double, filter::kPoseSize, 1>& pose_step,
                               double fraction) {
  const Vector2d step = -information.inverse() * (gradient + by_pose * pose_step);
  trial = value + fraction * step;
}

BrightnessPrior::BrightnessPrior(const config::PhotometricConfig& config, double common_gain)
    : common_gain_(common_gain) {
  // A tone curve changes the gains and offsets of dark and bright patches differently.
  constexpr double kOwnShare = 0.5;
  constexpr double kMiddle_grey = 128;
  const double own_gain = kOwnShare * std::abs(common_gain - 1);
  const auto widened = [](double sigma, double by) { return sigma > 0 ? std::hypot(sigma, by) : 0.0; };
  information_ = {prior_information(widened(config.gain_sigma, own_gain)),
                  prior_information(widened(config.offset_sigma_grey, own_gain * kMiddle_grey))};
}

double BrightnessPrior::cost(const Vector2d& gain_and_offset) const {
  const double gain = gain_and_offset.x() - common_gain_;
  const double offset = gain_and_offset.y();
  return 0.5 * (gain * gain * information_.x() + offset * offset * information_.y());
}

void BrightnessPrior::eliminate(PatchBrightness& light, filter::PoseQuadratic& photometric) const {
  light.information += information_.asDiagonal().toDenseMatrix();
  light.gradient += information_.cwiseProduct(light.value - mean());
  photometric.cost += cost(light.value);
  const Eigen::Matrix2d inverse = light.information.inverse();
  photometric.information -= light.by_pose.transpose() * inverse * light.by_pose;
  photometric.gradient -= light.by_pose.transpose() * inverse * light.gradient;
}

double common_gain(const patches::LevelLanes& level, const GreyImage& image) {
  constexpr std::size_t kFewestPatches = 5;
  constexpr double kSomeLight_grey = 5;  // below this level noise and the black level dominate
  std::vector<double> gains;
  for (std::size_t p = 0; p + 1 < level.first.size(); ++p) {
    simd::Float8 observed{}, reference{};
    int count = 0;
    for (std::size_t i = level.first[p]; i < level.first[p + 1]; ++i) {
      const patches::WarpedLanes& w = level.warped[i];
      observed += w.visible ? grey_at(image, w) : simd::Float8{};
      reference += w.visible ? level.pixels[i].intensity : simd::Float8{};
      count += std::popcount(simd::lane_bits(w.visible));
    }
    const double least = kSomeLight_grey * count;
    const double seen = simd::sum_of_lanes(observed), expected = simd::sum_of_lanes(reference);
    if (count > 0 && seen > least && expected > least) gains.push_back(seen / expected);
  }
  if (gains.size() < kFewestPatches) return 1;
  return upper_median(std::move(gains));
}

}  // namespace fusebench::measurement
