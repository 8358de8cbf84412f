#include "core/estimator/measurement/patch_readout.hpp"

namespace fusebench::measurement {

namespace {

// Columns of ReadoutVector.
constexpr int kColorReadout = 0;
constexpr int kDepthReadout = 1;
constexpr int kDepthDelay = 2;
constexpr int kOtherTiming = filter::kTimingSize;
constexpr int kRateAgainstReference = filter::kTimingSize + 1;
constexpr int kRateAgainstModel = kRateAgainstReference + filter::kPoseSize;

std::array<PoseByReadout, 2> none() { return {PoseByReadout::Zero(), PoseByReadout::Zero()}; }

void displace_by_rate(PoseByReadout& map, int rate, double seconds) {
  map.middleCols<filter::kPoseSize>(rate).diagonal().setConstant(seconds);
}

}  // namespace

void DisplacedPatches::add(const filter::PoseQuadratic& by_pose, const Vector2d& weights) {
  const std::array<double, 2> weight = {weights.x(), weights.y()};
  for (std::size_t i = 0, product = 0; i < 2; ++i) {
    information_[i] += weight[i] * by_pose.information;
    gradient_[i] += weight[i] * by_pose.gradient;
    for (std::size_t j = i; j < 2; ++j, ++product)
      products_[product] += weight[i] * weight[j] * by_pose.information;
  }
}

filter::ReadoutQuadratic DisplacedPatches::by_readout(const std::array<PoseByReadout, 2>& maps,
                                                      double variance) const {
  const auto& [first, second] = maps;
  filter::ReadoutQuadratic result;
  result.with_pose = information_[0] * first + information_[1] * second;
  result.gradient = first.transpose() * gradient_[0] + second.transpose() * gradient_[1];
  const auto crossed = (first.transpose() * products_[1] * second).eval();
  result.information = first.transpose() * products_[0] * first + crossed + crossed.transpose() +
                       second.transpose() * products_[2] * second;
  result.with_pose /= variance;
  result.information /= variance;
  result.gradient /= variance;
  return result;
}

std::array<PoseByReadout, 2> color_displacement(const ReadoutMotion& motion) {
  std::array<PoseByReadout, 2> maps = none();
  auto& [now, reference] = maps;
  if (motion.tells_color_readout) {
    now.col(kColorReadout) = motion.rate;
    reference.col(kColorReadout) = -motion.reference_rate;
  }
  reference.col(kOtherTiming) =
      -(motion.supposed_s[kColorReadout] - motion.reference_color_readout_s) * motion.reference_rate;
  // A patch is in about the same row of both images, so only the difference of the rates is observable.
  displace_by_rate(now, kRateAgainstReference, motion.color_readout_s);
  return maps;
}

std::array<PoseByReadout, 2> depth_displacement(const ReadoutMotion& motion) {
  std::array<PoseByReadout, 2> maps = none();
  auto& [always, now] = maps;
  // Surfaces that were fused from the same row during the same motion have equal displacements.
  const filter::FusedReadout& model = motion.model;
  always.col(kDepthDelay) = motion.rate - model.rate;
  always.col(kOtherTiming) = model.by_delay - motion.supposed_s[kDepthDelay] * model.rate;
  displace_by_rate(always, kRateAgainstModel, motion.depth_delay_s);
  now.col(kDepthReadout) = motion.rate - model.rate;
  now.col(kOtherTiming) = model.by_readout - motion.supposed_s[kDepthReadout] * model.rate;
  displace_by_rate(now, kRateAgainstModel, motion.depth_readout_s);
  return maps;
}

}  // namespace fusebench::measurement
