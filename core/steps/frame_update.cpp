#include "core/steps/frame_update.hpp"

#include <cmath>

#include "core/config/config.hpp"

namespace fusebench::core {

namespace {
/// Noise in the regressor biases the result towards zero: by 4 % at this signal-to-noise ratio.
constexpr double kLeastSignal = 5;
}  // namespace

double agreement(std::span<const measurement::PatchOutcome> outcomes) {
  double sum = 0;
  int count = 0;
  for (const measurement::PatchOutcome& outcome : outcomes) {
    if (!outcome.in_view) continue;
    ++count;
    if (outcome.tracked) sum += outcome.correlation;
  }
  return count > 0 ? sum / count : 0.0;
}

measurement::ReadoutMotion readout_motion(const filter::FilterState& prior, const FramePreparation& frame) {
  measurement::ReadoutMotion motion;
  const filter::FilterState& compensated = frame.compensated_motion() ? *frame.compensated_motion() : prior;
  if (frame.compensated_motion()) {
    motion.color_readout_s = frame.timing().color_readout_s;
    motion.depth_readout_s = frame.timing().depth_readout_s;
    motion.depth_delay_s = frame.timing().depth_delay_s;
  }
  const Vector6d rate_change = filter::pose_rate(compensated) - filter::pose_rate(prior);
  motion.compensated << compensated.sensors.timing_s() - prior.sensors.timing_s(), -1, rate_change,
      rate_change;
  motion.rate = filter::pose_rate(compensated);
  const Matrix6d carried = filter::pose_transport(prior.T_world_imu, prior.T_world_imu_reference);
  motion.reference_rate = carried * prior.reference_rate;
  motion.supposed_s = compensated.sensors.timing_s();
  motion.reference_color_readout_s = prior.reference_color_readout_s;
  motion.model = filter::transported(carried, prior.model_readout);
  // The difference has twice the variance of the IMU noise; the bias cancels.
  const double change_radps = (motion.rate - motion.reference_rate).head<3>().norm();
  const double noise_radps = std::sqrt(2.0) * prior.angular_velocity_noise_radps;
  motion.tells_color_readout = change_radps > kLeastSignal * noise_radps;
  return motion;
}

FrameUpdate::FrameUpdate(const config::Config& config, const SensorRig& rig, const Workers& workers)
    : config_(config),
      search_(config.alignment, config.patches.levels, config.photometric, config.iekf, rig),
      measurement_(config, rig, workers) {}

filter::IekfResult FrameUpdate::run_from(const filter::MeasuredVector& start,
                                         const filter::GaussianState& prior, const Tracking& last,
                                         const FramePreparation& frame, const Novelty& novelty) {
  measurement::ObservedFrame observed = frame.observed(novelty);
  if (config_.terms.motion_compensation) observed.motion = readout_motion(prior.mean, frame);
  // Without an IMU the read-out motion is estimated from the images alone, which the read-out distorts.
  const bool constants_can_be_told = config_.terms.prior == config::Prior::imu &&
                                     last.turned_rad >= config_.self_calibration.turn_before_rad;
  const auto constants =
      constants_can_be_told ? filter::SensorConstants::estimated : filter::SensorConstants::considered;
  measurement_.observe(observed, last.reference.patches, last.residual_scale);  // Eqs. 1-5, in each iterate
  return filter::iekf_update(prior, measurement_, config_.iekf, start, constants);  // Eqs. 15-23
}

filter::IekfResult FrameUpdate::run(const filter::GaussianState& prior, const Tracking& last,
                                    const FramePreparation& frame, const Novelty& novelty, bool thorough) {
  const alignment::ReferencePoints& points = last.reference.points;
  // Pose of a camera that stands still; for a relocalised frame, the pose of the matched keyframe.
  const SE3& last_pose =
      last.lost_frames == 0 ? last.estimate->mean.T_world_imu : prior.mean.T_world_imu_reference;
  const auto update_from = [&](const filter::MeasuredVector& start) {
    return run_from(start, prior, last, frame, novelty);
  };
  if (!novelty.color || config_.terms.photometric_weight <= 0)
    return update_from(filter::MeasuredVector::Zero());
  const alignment::FoundStart found = search_.find(prior, last_pose, points, frame.whole_pyramid(), thorough);
  filter::IekfResult first = update_from(found.start);
  // If the prediction is close enough there is no second basin of convergence.
  const double first_agreement = agreement(measurement_.outcomes());
  if (thorough || found.coarsest_level < 0 || first_agreement >= config_.health.sure_correlation)
    return first;
  const alignment::FoundStart other = search_.find(prior, last_pose, points, frame.whole_pyramid(), true);
  filter::IekfResult second = update_from(other.start);
  if (agreement(measurement_.outcomes()) > first_agreement) return second;
  return update_from(first.solution);
}

}  // namespace fusebench::core
