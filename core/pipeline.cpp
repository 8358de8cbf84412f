#include "core/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/config/config.hpp"
#include "core/estimator/acceptance/surviving_patches.hpp"
#include "core/estimator/acceptance/update_tests.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "core/estimator/filter/state_validity.hpp"
#include "core/estimator/measurement/patch_measurement.hpp"
#include "core/estimator/prediction/initialisation.hpp"
#include "core/estimator/prediction/motion_prior.hpp"
#include "core/steps/frames_without_update.hpp"

namespace fusebench::core {

namespace {

preprocessing::VelocityTolerance velocity_tolerance_to_update(const config::CompensationConfig& config) {
  return {config.update_again_angular_velocity_radps, config.update_again_velocity_mps};
}
preprocessing::VelocityTolerance velocity_tolerance_to_fuse(const config::CompensationConfig& config) {
  return {config.redo_angular_velocity_radps, config.redo_velocity_mps};
}

}  // namespace

Pipeline::Pipeline(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
                   const Workers& workers, std::unique_ptr<Tracking> tracking)
    : config_(config),
      rig_(rig),
      imu_(imu),
      workers_(workers),
      preparation_(config.terms, config.patches, config.depth, config.alignment, rig, workers),
      deformed_update_(config, rig, workers),
      tracking_(std::move(tracking)) {}

std::unique_ptr<Tracking> Pipeline::exchange(std::unique_ptr<Tracking> tracking) {
  return std::exchange(tracking_, std::move(tracking));
}

/// Processes one frame of the paper: Sec. 2.2.1 (prediction), 2.1 and 2.2.2 (deformation and iterated
/// update), 2.3 (fusion and new patches).
Result<health::FrameReport> Pipeline::process(const RgbdFrame& frame) {
  Tracking& now = *tracking_;
  health::FrameReport report = health::report_of(frame);
  check(!now.estimate || frame.capture_ns() > now.timestamp_ns, "frames come in the order of time");

  novelty_ = now.repeated_images.examine(frame);
  const bool repeated = !novelty_.color && !novelty_.depth;
  if (repeated && now.estimate && now.lost_frames == 0 &&
      config_.terms.prior == config::Prior::constant_velocity) {
    repeat_last(now, rig_, report);
    return report;
  }

  const Result<filter::GaussianState> predicted = predict(frame.capture_ns(), report.stages);  // Eqs. 8-14
  if (!predicted) return tl::unexpected(predicted.error());
  if (!filter::is_valid(*predicted)) {
    keep_moving(now, frame.capture_ns(), rig_, config_.health, config_.motion, report);
    return report;
  }
  if (is_carried_on(now, novelty_, config_.terms)) {
    carry_on(now, *predicted, frame.capture_ns(), rig_, report);
    return report;
  }
  now.carried_on = false;
  preparation_.prepare(frame, predicted->mean, report.stages);

  report.status = locate(*predicted, report);  // Eqs. 1-5, 15-23
  const bool updated =
      report.status == health::FrameStatus::tracked || report.status == health::FrameStatus::relocalised;
  if (!updated) now.estimate = dead_reckoned(*predicted, frame.capture_ns());
  if (report.status == health::FrameStatus::tracked)
    now.motion_scale = prediction::followed_scale(now.motion_scale, now.estimate->mean,
                                                  duration_s(frame.capture_ns()), config_.motion);
  return finish_frame(std::move(report), frame.capture_ns());
}

Result<health::FrameReport> Pipeline::relocalise_again(const RgbdFrame& frame,
                                                       const filter::GaussianState& prior,
                                                       const health::FrameReport& before) {
  health::FrameReport report = health::report_of(frame);
  report.health = before.health;
  report.stages = before.stages;
  tracking_->estimate = prior;
  if (!relocalise(prior, report) || report.placed_by_depth) return report;
  report.status = health::FrameStatus::relocalised;
  tracking_->loops.add_relocalisation(prior, *tracking_->estimate, tracking_->reference.timestamp_ns);
  return finish_frame(std::move(report), frame.capture_ns());
}

/// Fusion, patches and bookkeeping after the update.
Result<health::FrameReport> Pipeline::finish_frame(health::FrameReport report, std::int64_t capture_ns) {
  Tracking& now = *tracking_;
  now.lost_frames = report.status == health::FrameStatus::lost ? now.lost_frames + 1 : 0;
  now.timestamp_ns = capture_ns;
  if (report.status != health::FrameStatus::lost) now.located_ns = capture_ns;
  ++now.frames;

  // Colour and depth of different instants must be neither fused nor combined in a patch.
  if (now.fusion_gate.admits(report, novelty_.complete(), config_.health)) {
    const filter::FilterState& state = now.estimate->mean;
    preparation_.prepare_again(state, velocity_tolerance_to_fuse(config_.compensation), report.stages);
    const Result<void> fused = fuse(report);  // Sec. 2.3: M_k(X)
    if (!fused) return tl::unexpected(fused.error());
    report.fused = true;
    refresh(report.stages);  // Sec. 2.3: patch update
  }
  if (report.status == health::FrameStatus::initialised)
    report.health = health::judge_start(preparation_.observed(novelty_), now.reference.patches.size(),
                                        config_.health, config_.iekf, config_.patches.size_px);
  health::describe_state(*now.estimate, rig_.T_imu_camera, report);
  report.model_blocks = now.model.block_count();
  return report;
}

/// Sec. 2.2.1: propagates the state to the frame by IMU samples, or by constant velocity without an IMU.
Result<filter::GaussianState> Pipeline::predict(std::int64_t now_ns, health::StageTimes& stages) const {
  const health::StageClock clock(stages, health::Stage::predict);
  const Beginning& beginning = tracking_->beginning;
  if (!tracking_->estimate && beginning.state) return *beginning.state;
  if (!tracking_->estimate)
    return prediction::initial_state(imu_, now_ns, rig_, config_.terms, config_.initialisation,
                                     config_.self_calibration, beginning.motion);
  if (config_.terms.prior == config::Prior::constant_velocity)
    return prediction::predict_by_constant_velocity(*tracking_->estimate, duration_s(now_ns), config_.motion)
        .state;
  return prediction::predict_by_samples(*tracking_->estimate, {tracking_->timestamp_ns, now_ns}, imu_, rig_,
                                        config_.terms, config_.motion, config_.initialisation,
                                        config_.self_calibration);
}

/// State of a frame without an update. Differs from `predicted`, the prior of an update, which has an
/// intentionally wide covariance.
filter::GaussianState Pipeline::dead_reckoned(const filter::GaussianState& predicted,
                                              std::int64_t now_ns) const {
  const bool is_first = !tracking_->estimate;
  if (is_first || config_.terms.prior != config::Prior::constant_velocity) return predicted;
  return prediction::predict_by_motion_model(*tracking_->estimate, duration_s(now_ns),
                                             tracking_->motion_scale, config_.motion)
      .state;
}

bool Pipeline::measures_depth() const {
  return novelty_.depth &&
         health::depth_share(preparation_.frame().depth_m) >= config_.health.min_depth_share;
}

health::FrameStatus Pipeline::locate(const filter::GaussianState& predicted, health::FrameReport& report) {
  if (!tracking_->estimate) return health::FrameStatus::initialised;
  if (track(predicted, false, report)) return health::FrameStatus::tracked;
  const bool is_covered = report.health == health::FrameHealth::dark && !measures_depth();
  if (novelty_.color && !is_covered && track_again(predicted, true, report))
    return health::FrameStatus::tracked;
  const filter::GaussianState reckoned = dead_reckoned(predicted, preparation_.frame().capture_ns());
  if (!relocalise(reckoned, report)) return health::FrameStatus::lost;
  tracking_->loops.add_relocalisation(reckoned, *tracking_->estimate, tracking_->reference.timestamp_ns);
  return health::FrameStatus::relocalised;
}

/// Secs. 2.1 and 2.2.2: each iterate of the update (Eq. 18) deforms the patches into the frame (Eqs. 1-2,
/// shrink and extend effects) and reduces the residuals (Eqs. 3-5), in PatchMeasurement::linearise(). The
/// images are compensated for the motion that the update estimates.
filter::IekfResult Pipeline::update(const filter::GaussianState& prior, bool thorough,
                                    health::StageTimes& stages) {
  const auto timed = [&](const auto& run) {
    const health::StageClock clock(stages, health::Stage::update);
    return run();
  };
  const preprocessing::VelocityTolerance tolerance = velocity_tolerance_to_update(config_.compensation);
  preparation_.prepare_again(prior.mean, tolerance, stages);
  filter::IekfResult result =
      timed([&] { return deformed_update_.run(prior, *tracking_, preparation_, novelty_, thorough); });
  for (int again = 0; again < config_.compensation.max_updates_again && filter::is_valid(result.posterior);
       ++again) {
    if (!preparation_.prepare_again(result.posterior.mean, tolerance, stages)) break;
    result = timed([&] {
      return deformed_update_.run_from(result.solution, prior, *tracking_, preparation_, novelty_);
    });
  }
  return result;
}

/// Runs the update. False if it is rejected.
bool Pipeline::track(const filter::GaussianState& prior, bool thorough, health::FrameReport& report) {
  Tracking& now = *tracking_;
  const filter::IekfResult update = this->update(prior, thorough, report.stages);  // Eqs. 1-5, 15-23
  const health::StageClock clock(report.stages, health::Stage::update);
  report.blur_px = preprocessing::predicted_blur_px(prior.mean, rig_, config_.motion.exposure_s);
  if (!filter::is_valid(update.posterior)) {
    report.health = health::FrameHealth::diverged;
    report.reason = fmt::format("{}: the update is not finite", health::to_string(report.health));
    return false;
  }
  if (config_.terms.patch_motion == config::PatchMotion::own_translation && novelty_.color)
    deformed_update_.move_patches_alone(prior);
  const std::span<const measurement::PatchOutcome> outcomes = deformed_update_.measurement().outcomes();
  health::describe_update(deformed_update_.measurement(), update, now.reference.patches, config_.health,
                          config_.iekf, report);
  report.health = health::judge_health(preparation_.observed(novelty_), outcomes, report.blur_px,
                                       config_.health, config_.iekf, config_.patches.size_px);
  report.reason = acceptance::rejection_reason(report, config_.terms, config_.iekf, config_.health);
  if (!report.reason.empty()) {
    // Resets the learned noise scale; otherwise one lighting change or blur would reject every later frame.
    now.residual_scale = {std::max(1.0, now.residual_scale.photometric),
                          std::max(1.0, now.residual_scale.geometric)};
    return false;
  }
  report.evidence =
      health::PoseEvidence{now.reference.timestamp_ns, prior.mean.T_world_imu_reference,
                           update.posterior.mean.T_world_imu, update.measurement, update.timing};
  now.turned_rad +=
      rotation_angle_rad(now.estimate->mean.T_world_imu.rotation, update.posterior.mean.T_world_imu.rotation);
  now.estimate = update.posterior;
  if (novelty_.complete()) now.color_drift.observe(filter::correction_in_imu(update), config_.color_drift);
  if (report.health == health::FrameHealth::good && !novelty_.complete())
    report.health = health::FrameHealth::repeated;
  if (report.health != health::FrameHealth::occluded && novelty_.complete())
    now.residual_scale = measurement::followed_scale(now.residual_scale, outcomes, config_.iekf,
                                                     config_.photometric, config_.geometric);
  acceptance::find_survivors(now.reference.patches, outcomes, config_.patches, now.survivors);
  return true;
}

/// Retries track() with a fresh report. Keeps the first report if the retry fails.
bool Pipeline::track_again(const filter::GaussianState& prior, bool thorough, health::FrameReport& report) {
  health::FrameReport again = health::report_of(preparation_.frame());
  again.stages = report.stages;
  const bool tracked = track(prior, thorough, again);
  if (tracked) {
    report = std::move(again);
  } else {
    report.stages = again.stages;
  }
  return tracked;
}

/// Searches the frame among the keyframes and tracks it with the patches of a match. If these are not
/// visible, accepts a pose that depth has verified.
bool Pipeline::relocalise(const filter::GaussianState& prediction, health::FrameReport& report) {
  if (!config_.terms.relocalisation || !novelty_.color) return false;
  Tracking& now = *tracking_;
  const bool dark = report.health == health::FrameHealth::dark;
  std::optional<relocalisation::RelocalisedReference> found;
  {
    const health::StageClock clock(report.stages, health::Stage::update);
    found = now.relocalisation.find(preparation_.frame(), {!dark, measures_depth()}, prediction, now.model,
                                    workers_);
  }
  if (!found) return false;
  std::swap(now.reference, found->reference);
  if (!dark && track_again(found->prior, false, report)) {
    report.pixels = {};  // the intensity error is defined against the anchor
    return true;
  }
  if (found->by_depth) {
    now.estimate = found->prior;
    report.placed_by_depth = true;
    report.reason += "; placed by depth alone, not fused";
    return true;
  }
  std::swap(now.reference, found->reference);
  return false;
}

/// Sec. 2.3: fuses the depth image into the model at the updated pose. With online loop closure, excludes
/// depth that contradicts an old surface (deferred fusion).
Result<void> Pipeline::fuse(health::FrameReport& report) {
  preparation_.prepare_color(report.stages);
  const health::StageClock clock(report.stages, health::Stage::fuse);
  const RgbdFrame& frame = preparation_.frame();
  if (!tracking_->loops.may_correct_online()) return integrate(frame);
  auto rest_m = tracking_->revisits.depth_to_fuse(tracking_->model, frame, T_world_camera(), workers_);
  if (!rest_m) return integrate(frame);
  if (report.health == health::FrameHealth::good) report.health = health::FrameHealth::revisit_pending;
  RgbdFrame rest = frame;
  rest.depth_m = std::move(*rest_m);
  return integrate(rest);
}

Result<void> Pipeline::integrate(const RgbdFrame& frame) {
  return tracking_->model.integrate(frame, rig_.camera, T_world_camera(), config_.depth, workers_);
}

Result<void> Pipeline::fuse_again(const RgbdFrame& frame, const filter::FilterState& state) {
  health::StageTimes stages;
  tracking_->estimate->mean = state;
  preparation_.prepare(frame, state, stages);
  preparation_.prepare_color(stages);
  return integrate(preparation_.frame());
}

void Pipeline::resume(const filter::GaussianState& estimate) {
  Tracking& now = *tracking_;
  now.estimate = filter::cloned_as_reference(estimate, preparation_.compensated_readout(estimate.mean));
  now.reference.timestamp_ns = now.timestamp_ns;
  cut_patches();
}

/// Sec. 2.3: cuts surviving patches again as squares, adds new corners, takes depth from the model. Otherwise
/// the patches keep their reference frame.
void Pipeline::refresh(health::StageTimes& stages) {
  const health::StageClock clock(stages, health::Stage::refresh);
  Tracking& now = *tracking_;
  const filter::CompensatedReadout compensated = preparation_.compensated_readout(now.estimate->mean);
  const bool is_first = now.reference.patches.empty();
  const bool anew =
      is_first || acceptance::needs_new_anchor(deformed_update_.measurement().outcomes(), config_.patches);
  if (anew) cut_patches();
  const double share =
      patches::fused_share(now.model, now.reference.patches, reference_frame(), config_.depth);
  now.estimate = filter::fused_into_model(*now.estimate, {share, config_.motion.drift_factor}, compensated);
  if (anew) {
    now.reference.timestamp_ns = now.timestamp_ns;
    now.estimate = filter::cloned_as_reference(*now.estimate, compensated);
    if (!is_first)
      now.estimate = filter::with_anchor_noise(*std::move(now.estimate),
                                               deformed_update_.measurement().color_information());
  }
  now.estimate =
      filter::with_reference_noise(*std::move(now.estimate), now.color_drift.noise(config_.color_drift));
  const RgbdFrame& frame = preparation_.frame();
  const double blur_px =
      preprocessing::predicted_blur_px(now.estimate->mean, rig_, config_.motion.exposure_s);
  now.relocalisation.add_keyframe(frame, T_world_camera(), now.timestamp_ns, blur_px);
  now.loops.add_fused(frame, *now.estimate, blur_px);
}

void Pipeline::cut_patches() {
  Tracking& now = *tracking_;
  patches::refresh_patches(reference_frame(), now.model, now.survivors,
                           {config_.patches, config_.depth, config_.terms.deformation}, workers_,
                           patch_workspace_, now.reference.patches);
  now.reference.points.take(preparation_.whole_pyramid(), preparation_.frame().depth_m, rig_.camera,
                            config_.alignment);
}

}  // namespace fusebench::core
