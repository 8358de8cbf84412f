#include "core/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/config/config.hpp"
#include "core/filter/iekf.hpp"
#include "core/filter/moved_state.hpp"
#include "core/filter/pose_clones.hpp"
#include "core/filter/state_validity.hpp"
#include "core/frame_preparation.hpp"
#include "core/frame_update.hpp"
#include "core/frames_without_update.hpp"
#include "core/measurement/patch_measurement.hpp"
#include "core/prediction/initialisation.hpp"
#include "core/prediction/motion_prior.hpp"
#include "core/recording_start.hpp"
#include "core/tracking_state.hpp"

namespace fusebench::core {

namespace {

preprocessing::VelocityTolerance velocity_tolerance_to_update(const config::CompensationConfig& config) {
  return {config.update_again_angular_velocity_radps, config.update_again_velocity_mps};
}
preprocessing::VelocityTolerance velocity_tolerance_to_fuse(const config::CompensationConfig& config) {
  return {config.redo_angular_velocity_radps, config.redo_velocity_mps};
}

}  // namespace

struct Pipeline::State final : RestartableEstimator {
  State(const config::Config& config_in, const SensorRig& rig_in, std::span<const ImuSample> imu_in,
        const Workers& workers_in)
      : config(config_in),
        rig(rig_in),
        imu(imu_in),
        workers(workers_in),
        preparation(config.terms, config.patches, config.depth, config.alignment, rig, workers),
        deformed_update(config, rig, workers),
        tracking(std::in_place, config, rig) {
    // Constant velocity is of the camera: without an IMU its place and orientation must not matter either.
    if (config.terms.prior == config::Prior::constant_velocity) rig.T_imu_camera = SE3{};
  }

  Result<health::FrameReport> process_frame(const RgbdFrame& frame) override;
  Result<health::FrameReport> estimate_frame(const RgbdFrame& frame);
  const std::optional<filter::GaussianState>& estimate() const override { return tracking->estimate; }
  void restart(const std::optional<filter::FilterState>& motion) override;

  Result<filter::GaussianState> predict(std::int64_t now_ns, health::StageTimes& stages) const;
  filter::GaussianState dead_reckoned(const filter::GaussianState& predicted, std::int64_t now_ns) const;
  health::FrameStatus locate(const filter::GaussianState& predicted, health::FrameReport& report);
  bool track(const filter::GaussianState& prior, bool thorough, health::FrameReport& report);
  filter::IekfResult update(const filter::GaussianState& prior, bool thorough, health::StageTimes& stages);
  bool track_again(const filter::GaussianState& prior, bool thorough, health::FrameReport& report);
  bool relocalise(const filter::GaussianState& prediction, health::FrameReport& report);
  Result<void> fuse(health::FrameReport& report);
  Result<void> integrate(const RgbdFrame& frame) {
    return tracking->model.integrate(frame, rig.camera, T_world_camera(), config.depth, workers);
  }
  void refresh(health::StageTimes& stages);
  void cut_patches();
  void begin_again(const SE3& T_corrected_current);
  /// What patches are cut from.
  [[nodiscard]] patches::ReferenceFrame reference_frame() const {
    return {preparation.pyramid(), preparation.patch_depth_m(), rig.camera, T_world_camera()};
  }
  /// Since the frame before.
  [[nodiscard]] double duration_s(std::int64_t now_ns) const {
    return seconds_between(tracking->timestamp_ns, now_ns);
  }
  [[nodiscard]] SE3 T_world_camera() const { return tracking->estimate->mean.T_world_imu * rig.T_imu_camera; }

  config::Config config;
  SensorRig rig;
  std::span<const ImuSample> imu;
  const Workers& workers;
  Novelty novelty;               ///< of the current frame
  FramePreparation preparation;  ///< of the current frame
  FrameUpdate deformed_update;   ///< by the patches, deformed into the current frame
  patches::PatchWorkspace patch_workspace;
  std::optional<Tracking> tracking;                   ///< always there
  std::optional<filter::FilterState> initial_motion;  ///< after a restart
  RecordingStart start{config.initialisation};
  std::optional<filter::GaussianState> corrected;  ///< by a loop, to go on with once the model is there again
};

/// One frame of the paper: Sec. 2.2.1 (prediction), 2.1 and 2.2.2 (deformation and iterated update), 2.3
/// (fusion and new patches).
Result<health::FrameReport> Pipeline::State::estimate_frame(const RgbdFrame& frame) {
  Tracking& now = *tracking;
  health::FrameReport report = health::report_of(frame);
  check(!now.estimate || frame.capture_ns() > now.timestamp_ns, "frames come in the order of time");

  novelty = now.repeated_images.examine(frame);
  const bool repeated = !novelty.color && !novelty.depth;
  if (repeated && now.estimate && now.lost_frames == 0 &&
      config.terms.prior == config::Prior::constant_velocity) {
    repeat_last(now, rig, report);
    return report;
  }

  const Result<filter::GaussianState> predicted = predict(frame.capture_ns(), report.stages);  // Eqs. 8-14
  if (!predicted) return tl::unexpected(predicted.error());
  if (!filter::is_valid(*predicted)) {
    keep_moving(now, frame.capture_ns(), rig, config.health, config.motion, report);
    return report;
  }
  if (is_carried_on(now, novelty, config.terms)) {
    carry_on(now, *predicted, frame.capture_ns(), rig, report);
    return report;
  }
  now.carried_on = false;
  preparation.prepare(frame, predicted->mean, report.stages);

  report.status = locate(*predicted, report);  // Eqs. 1-5, 15-23
  const bool updated =
      report.status == health::FrameStatus::tracked || report.status == health::FrameStatus::relocalised;
  if (!updated) now.estimate = dead_reckoned(*predicted, frame.capture_ns());
  if (report.status == health::FrameStatus::tracked)
    now.motion_scale = prediction::followed_scale(now.motion_scale, now.estimate->mean,
                                                  duration_s(frame.capture_ns()), config.motion);
  now.lost_frames = report.status == health::FrameStatus::lost ? now.lost_frames + 1 : 0;
  now.timestamp_ns = frame.capture_ns();
  ++now.frames;

  // Colour and depth of different instants belong neither into the model nor together into a patch.
  if (now.occlusion_gate.admits(report, config.health) && novelty.complete()) {
    const filter::FilterState& state = now.estimate->mean;
    preparation.prepare_again(state, velocity_tolerance_to_fuse(config.compensation), report.stages);
    const Result<void> fused = fuse(report);  // Sec. 2.3: M_k(X)
    if (!fused) return tl::unexpected(fused.error());
    refresh(report.stages);  // Sec. 2.3: patch update
  }
  if (report.status == health::FrameStatus::initialised)
    report.health = health::judge_start(preparation.observed(novelty), now.reference.patches.size(),
                                        config.health, config.iekf, config.patches.size_px);
  health::describe_state(*now.estimate, rig.T_imu_camera, report);
  report.model_blocks = now.model.block_count();
  return report;
}

Result<health::FrameReport> Pipeline::State::process_frame(const RgbdFrame& frame) {
  auto report = estimate_frame(frame);
  if (!report || report->status == health::FrameStatus::lost) return report;
  tracking->loops.add_pose(report->timestamp_ns, report->T_world_camera);
  const auto moved = tracking->loops.correct_online();
  if (!moved) return tl::unexpected(moved.error());
  if (*moved) begin_again(**moved);
  return report;
}

/// The world moves, and the model has to be made again.
void Pipeline::State::begin_again(const SE3& T_corrected_current) {
  Tracking& now = *tracking;
  corrected = filter::moved(*now.estimate, T_corrected_current);
  now.model = tsdf::TsdfVolume(config.tsdf);
  now.relocalisation.move(
      [&](std::int64_t timestamp_ns) { return now.loops.corrected_pose_near(timestamp_ns); });
}

void Pipeline::State::restart(const std::optional<filter::FilterState>& motion) {
  initial_motion = motion;
  tracking.emplace(config, rig);
}

/// Sec. 2.2.1: IMU samples carry the state to the frame; without an IMU, constant velocity does.
Result<filter::GaussianState> Pipeline::State::predict(std::int64_t now_ns,
                                                       health::StageTimes& stages) const {
  const health::StageClock clock(stages, health::Stage::predict);
  if (!tracking->estimate)
    return prediction::initial_state(imu, now_ns, rig, config.terms, config.initialisation,
                                     config.self_calibration, initial_motion);
  if (config.terms.prior == config::Prior::constant_velocity)
    return prediction::predict_by_constant_velocity(*tracking->estimate, duration_s(now_ns), config.motion)
        .state;
  return prediction::predict_by_samples(*tracking->estimate, {tracking->timestamp_ns, now_ns}, imu, rig,
                                        config.terms, config.motion, config.initialisation,
                                        config.self_calibration);
}

/// The state of a frame without an update. The prior of an update, which is wide on purpose, is `predicted`.
filter::GaussianState Pipeline::State::dead_reckoned(const filter::GaussianState& predicted,
                                                     std::int64_t now_ns) const {
  const bool is_first = !tracking->estimate;
  if (is_first || config.terms.prior != config::Prior::constant_velocity) return predicted;
  return prediction::predict_by_motion_model(*tracking->estimate, duration_s(now_ns), tracking->motion_scale,
                                             config.motion)
      .state;
}

health::FrameStatus Pipeline::State::locate(const filter::GaussianState& predicted,
                                            health::FrameReport& report) {
  if (!tracking->estimate) return health::FrameStatus::initialised;
  if (track(predicted, false, report)) return health::FrameStatus::tracked;
  if (novelty.color && track_again(predicted, true, report)) return health::FrameStatus::tracked;
  const filter::GaussianState reckoned = dead_reckoned(predicted, preparation.frame().capture_ns());
  if (!relocalise(reckoned, report)) return health::FrameStatus::lost;
  tracking->loops.add_relocalisation(reckoned, *tracking->estimate, tracking->reference.timestamp_ns);
  return health::FrameStatus::relocalised;
}

/// Secs. 2.1 and 2.2.2: the patches are deformed into the frame (Eqs. 1-2, shrink and extend effects) by each
/// iterate of the update (Eq. 18), which minimises what is left between them and the images (Eqs. 3-5), in
/// PatchMeasurement::linearise(). The images are those of the frame's instant by the motion that the update
/// finds.
filter::IekfResult Pipeline::State::update(const filter::GaussianState& prior, bool thorough,
                                           health::StageTimes& stages) {
  const auto timed = [&](const auto& run) {
    const health::StageClock clock(stages, health::Stage::update);
    return run();
  };
  const preprocessing::VelocityTolerance tolerance = velocity_tolerance_to_update(config.compensation);
  preparation.prepare_again(prior.mean, tolerance, stages);
  filter::IekfResult result =
      timed([&] { return deformed_update.run(prior, *tracking, preparation, novelty, thorough); });
  for (int again = 0; again < config.compensation.max_updates_again && filter::is_valid(result.posterior);
       ++again) {
    if (!preparation.prepare_again(result.posterior.mean, tolerance, stages)) break;
    result = timed(
        [&] { return deformed_update.run_from(result.solution, prior, *tracking, preparation, novelty); });
  }
  return result;
}

/// False if the result of the update is not to be believed.
bool Pipeline::State::track(const filter::GaussianState& prior, bool thorough, health::FrameReport& report) {
  Tracking& now = *tracking;
  const filter::IekfResult update = this->update(prior, thorough, report.stages);  // Eqs. 1-5, 15-23
  const health::StageClock clock(report.stages, health::Stage::update);
  report.blur_px = preprocessing::predicted_blur_px(prior.mean, rig, config.motion.exposure_s);
  if (!filter::is_valid(update.posterior)) {
    report.health = health::FrameHealth::diverged;
    report.reason = fmt::format("{}: the update is not finite", health::to_string(report.health));
    return false;
  }
  if (config.terms.patch_motion == config::PatchMotion::own_translation && novelty.color)
    deformed_update.move_patches_alone(prior);
  const std::span<const measurement::PatchOutcome> outcomes = deformed_update.measurement().outcomes();
  health::describe_update(deformed_update.measurement(), update, now.reference.patches, config.health,
                          config.iekf, report);
  report.health = health::judge_health(preparation.observed(novelty), outcomes, report.blur_px, config.health,
                                       config.iekf, config.patches.size_px);
  report.reason = health::rejection_reason(report, config.terms, config.iekf, config.health);
  if (!report.reason.empty()) {
    // A light or a blur that the learnt noise does not allow must not lock every frame out.
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
  if (novelty.complete()) now.color_drift.observe(filter::correction_in_imu(update), config.color_drift);
  if (report.health == health::FrameHealth::good && !novelty.complete())
    report.health = health::FrameHealth::repeated;
  if (report.health != health::FrameHealth::occluded && novelty.complete())
    now.residual_scale = measurement::followed_scale(now.residual_scale, outcomes, config.iekf,
                                                     config.photometric, config.geometric);
  health::find_survivors(now.reference.patches, outcomes, config.patches, now.survivors);
  return true;
}

/// The same once more with a report of its own; the report of the first attempt stays if this one fails.
bool Pipeline::State::track_again(const filter::GaussianState& prior, bool thorough,
                                  health::FrameReport& report) {
  health::FrameReport again = health::report_of(preparation.frame());
  again.stages = report.stages;
  const bool tracked = track(prior, thorough, again);
  if (tracked) {
    report = std::move(again);
  } else {
    report.stages = again.stages;
  }
  return tracked;
}

/// Looks for the frame among the keyframes, and tracks it from there with their patches; where these cannot
/// be seen, a pose that depth has verified is taken as it is.
bool Pipeline::State::relocalise(const filter::GaussianState& prediction, health::FrameReport& report) {
  if (!config.terms.relocalisation || !novelty.color) return false;
  Tracking& now = *tracking;
  const bool dark = report.health == health::FrameHealth::dark;
  if (const auto motion = now.relocalisation.motion_by_places(report.timestamp_ns, prediction.mean))
    preparation.prepare_again(*motion, velocity_tolerance_to_update(config.compensation), report.stages);
  std::optional<relocalisation::RelocalisedReference> found;
  {
    const health::StageClock clock(report.stages, health::Stage::update);
    found =
        now.relocalisation.find(preparation.frame(), {!dark, novelty.depth}, prediction, now.model, workers);
  }
  if (!found) return false;
  std::swap(now.reference, found->reference);
  if (!dark && track_again(found->prior, false, report)) {
    report.pixels = {};  // the intensity error is one against the frame before
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

/// Sec. 2.3: the depth image goes into the model at the updated pose. Where loops are closed online, without
/// what an old surface contradicts: the loop will tell.
Result<void> Pipeline::State::fuse(health::FrameReport& report) {
  preparation.prepare_color(report.stages);
  const health::StageClock clock(report.stages, health::Stage::fuse);
  const RgbdFrame& frame = preparation.frame();
  if (!tracking->loops.may_correct_online()) return integrate(frame);
  auto rest_m = tracking->revisits.depth_to_fuse(tracking->model, frame, T_world_camera(), workers);
  if (!rest_m) return integrate(frame);
  if (report.health == health::FrameHealth::good) report.health = health::FrameHealth::revisit_pending;
  RgbdFrame rest = frame;
  rest.depth_m = std::move(*rest_m);
  return integrate(rest);
}

/// Sec. 2.3: surviving patches are cut again as squares, new corners join them, depth comes from the model.
void Pipeline::State::refresh(health::StageTimes& stages) {
  const health::StageClock clock(stages, health::Stage::refresh);
  Tracking& now = *tracking;
  cut_patches();
  now.reference.timestamp_ns = now.timestamp_ns;
  const double share =
      patches::fused_share(now.model, now.reference.patches, reference_frame(), config.depth);
  now.estimate = filter::cloned_after_fusion(*now.estimate, {share, config.motion.drift_factor},
                                             now.color_drift.noise(config.color_drift),
                                             preparation.undone_readout(now.estimate->mean));
  const RgbdFrame& frame = preparation.frame();
  const double blur_px = preprocessing::predicted_blur_px(now.estimate->mean, rig, config.motion.exposure_s);
  now.relocalisation.add_keyframe(frame, T_world_camera(), now.timestamp_ns, blur_px);
  now.loops.add_fused(frame, *now.estimate, blur_px);
}

void Pipeline::State::cut_patches() {
  Tracking& now = *tracking;
  patches::refresh_patches(reference_frame(), now.model, now.survivors,
                           {config.patches, config.depth, config.terms.deformation}, workers, patch_workspace,
                           now.reference.patches);
  now.reference.points.take(preparation.whole_pyramid(), preparation.frame().depth_m, rig.camera,
                            config.alignment);
}

Pipeline::Pipeline(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
                   const Workers& workers)
    : state_(std::make_unique<State>(config, rig, imu, workers)) {}
Pipeline::~Pipeline() = default;

Result<health::FrameReport> Pipeline::process(const RgbdFrame& frame) {
  return state_->start.process(frame, *state_);
}

Result<std::optional<Trajectory>> Pipeline::revise() {
  Tracking& last = *state_->tracking;
  const Result<bool> changed = last.loops.close();
  if (!changed) return tl::unexpected(changed.error());
  if (!*changed) return std::nullopt;
  last.model = tsdf::TsdfVolume(state_->config.tsdf);
  return last.loops.corrected_trajectory();
}

/// Sec. 2.3 once more, at the revised pose and for the motion that the frame turned out to have.
Result<void> Pipeline::fuse_again(const RgbdFrame& frame) {
  const std::optional<filter::FilterState> state =
      state_->tracking->loops.corrected_state(frame.timestamp_ns);
  if (!state) return {};
  health::StageTimes stages;
  state_->tracking->estimate->mean = *state;
  state_->preparation.prepare(frame, *state, stages);
  state_->preparation.prepare_color(stages);
  return state_->integrate(state_->preparation.frame());
}

bool Pipeline::wants_frames_again() const { return state_->corrected.has_value(); }

/// The last frame that came again is the one that patches were cut from: they are cut again, from the new
/// model.
void Pipeline::resume() {
  Tracking& now = *state_->tracking;
  now.estimate = std::exchange(state_->corrected, std::nullopt);
  for (patches::TrackedCentre& centre : now.survivors) centre.kept.reset();
  state_->cut_patches();
}

const loops::LoopClosure* Pipeline::loops() const {
  const loops::LoopClosure& loops = state_->tracking->loops;
  return loops.enabled() ? &loops : nullptr;
}

const tsdf::TsdfVolume& Pipeline::model() const { return state_->tracking->model; }

tsdf::TsdfVolume Pipeline::take_model() && {
  const std::unique_ptr<State> last = std::move(state_);
  return std::move(last->tracking->model);
}

}  // namespace fusebench::core
