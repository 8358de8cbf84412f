#include "core/steps/frames_without_update.hpp"

#include <fmt/format.h>

#include <tuple>

#include "core/config/groups/health_config.hpp"
#include "core/config/groups/prediction_config.hpp"
#include "core/config/groups/terms_config.hpp"
#include "core/estimator/prediction/motion_prior.hpp"

namespace fusebench::core {

void repeat_last(const Tracking& now, const SensorRig& rig, health::FrameReport& report) {
  report.status = health::FrameStatus::tracked;
  report.health = health::FrameHealth::repeated;
  report.reason = "colour and depth repeat the previous frame";
  health::describe_state(*now.estimate, rig.T_imu_camera, report);
  report.model_blocks = now.model.block_count();
}

bool is_carried_on(const Tracking& now, const Novelty& novelty, const config::TermsConfig& terms) {
  return !novelty.color && terms.prior == config::Prior::constant_velocity && terms.photometric_weight > 0 &&
         now.estimate && now.lost_frames == 0 && !now.carried_on;
}

void carry_on(Tracking& now, const filter::GaussianState& predicted, std::int64_t now_ns,
              const SensorRig& rig, health::FrameReport& report) {
  now.estimate = predicted;
  now.carried_on = true;
  ++now.frames;
  now.timestamp_ns = now.located_ns = now_ns;
  report.status = health::FrameStatus::tracked;
  report.health = health::FrameHealth::repeated;
  report.reason = "colour repeats the previous frame: the pose is predicted";
  report.certainty = health::certainty_of(predicted);
  health::describe_state(predicted, rig.T_imu_camera, report);
  report.model_blocks = now.model.block_count();
}

void keep_moving(Tracking& now, std::int64_t now_ns, const SensorRig& rig,
                 const config::HealthConfig& health_options, const config::MotionConfig& motion,
                 health::FrameReport& report) {
  report.health = health::FrameHealth::diverged;
  report.reason = fmt::format("{}: the state predicted from the inertial samples is not finite",
                              health::to_string(report.health));
  std::ignore = now.fusion_gate.admits(report, false, health_options);
  if (!now.estimate) return;
  now.estimate = prediction::predict_by_motion_model(*now.estimate, seconds_between(now.timestamp_ns, now_ns),
                                                     now.motion_scale, motion)
                     .state;
  ++now.frames;
  ++now.lost_frames;
  now.timestamp_ns = now_ns;
  health::describe_state(*now.estimate, rig.T_imu_camera, report);
  report.model_blocks = now.model.block_count();
}

}  // namespace fusebench::core
