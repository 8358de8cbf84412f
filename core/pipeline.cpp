#include "core/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "core/depth_gates.hpp"
#include "core/iekf.hpp"
#include "core/initialisation.hpp"
#include "core/keyframes.hpp"
#include "core/motion_compensation.hpp"
#include "core/motion_prior.hpp"
#include "core/patch_measurement.hpp"
#include "core/patches.hpp"
#include "core/pose_anchors.hpp"
#include "core/resumption.hpp"
#include "core/state_validity.hpp"

namespace fusebench {

namespace {

/// What is derived from a frame before it is used. Its memory serves one frame after the other.
struct PreparedFrame {
  std::vector<GreyImage> pyramid;
  RgbdFrame frame;  ///< motion compensated, depth gated; compensated ones have an earlier colour until
                    ///< prepare_color()
  DepthImage ungated_depth_m;  ///< before the gates
  CameraVelocity velocity;     ///< that it was compensated for, if at all
};

/// Adds the time since its construction to one stage.
class StageClock {
 public:
  StageClock(FrameReport& report, Stage stage)
      : stages_(report.stages), stage_(stage), begin_(std::chrono::steady_clock::now()) {}
  ~StageClock() { stages_.add({stage_, {begin_, std::chrono::steady_clock::now()}}); }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

 private:
  StageTimes& stages_;
  Stage stage_;
  std::chrono::steady_clock::time_point begin_;
};

/// As the filter wants it: of the IMU.
RecognisedPlace recognised_place(const FoundPlace& found, const Keyframe& keyframe, const SE3& T_imu_camera) {
  const SE3 T_camera_imu = T_imu_camera.inverse();
  RecognisedPlace place{found.T_world_camera * T_camera_imu, keyframe.T_world_camera * T_camera_imu};
  const Matrix6d to_imu = pose_transport(place.T_world_imu, found.T_world_camera);
  place.covariance = to_imu * found.covariance * to_imu.transpose();
  // What the model has moved since the frame was fused into it.
  constexpr double kRotation_rad = 0.005;
  constexpr double kPosition_m = 0.005;
  place.reference_covariance.diagonal() << Vector3d::Constant(kRotation_rad * kRotation_rad),
      Vector3d::Constant(kPosition_m * kPosition_m);
  return place;
}

}  // namespace

struct Pipeline::State {
  State(const Config& config_in, const SensorRig& rig_in, std::span<const ImuSample> imu_in,
        const Workers& workers_in)
      : config(config_in),
        rig(rig_in),
        imu(imu_in),
        workers(workers_in),
        model(config_in.tsdf),
        keyframes(rig_in.camera),
        measurement(config, rig, workers) {
    // Constant velocity is of the camera: without an IMU its place and orientation must not matter either.
    if (config.terms.prior == Prior::constant_velocity) rig.T_imu_camera = SE3{};
  }

  Result<FrameReport> process(const RgbdFrame& frame);
  Result<FrameReport> process_once(const RgbdFrame& frame);
  Result<FrameReport> restart_in_motion(const RgbdFrame& second, StageTimes so_far);
  [[nodiscard]] CameraVelocity camera_velocity(const FilterState& motion) const;
  [[nodiscard]] double predicted_blur_px(const FilterState& motion) const;
  [[nodiscard]] bool moved_otherwise(const GaussianState& predicted) const;
  [[nodiscard]] bool settled_wrongly(const FrameReport& report) const;
  void prepare(const RgbdFrame& frame, const FilterState& motion, FrameReport& report);
  void prepare_color(const RgbdFrame& frame, FrameReport& report);
  [[nodiscard]] bool compensates(const RgbdFrame& frame) const;
  Result<GaussianState> predict(std::int64_t timestamp_ns, FrameReport& report) const;
  FrameStatus locate(const GaussianState& predicted, FrameReport& report);
  bool track(const GaussianState& prior, bool after_gap, FrameReport& report);
  bool relocalise(const GaussianState& prediction, FrameReport& report);
  Result<void> fuse(FrameReport& report);
  void refresh(FrameReport& report);
  void leave_out(const RgbdFrame& frame, FrameReport& report);
  void describe_state(FrameReport& report) const;
  void keep_place(FrameReport& report);
  [[nodiscard]] SE3 T_world_camera() const { return estimate->mean.T_world_imu * rig.T_imu_camera; }

  Config config;
  SensorRig rig;
  std::span<const ImuSample> imu;
  const Workers& workers;
  TsdfVolume model;
  PreparedFrame prepared;                 ///< of the current frame
  Keyframes keyframes;                    ///< fused frames, by which a lost tracker finds its place
  std::optional<GaussianState> estimate;  ///< after the last frame
  std::int64_t timestamp_ns = 0;          ///< instant of the last frame
  std::optional<RgbdFrame> first_frame;   ///< until the second one has told how fast it was
  std::optional<FilterState> initial_motion;
  std::vector<Patch> patches;  ///< cut from the last fused frame
  PatchWorkspace patch_workspace;
  PatchMeasurement measurement;          ///< of them in the current frame
  int occluded_frames = 0;               ///< in a row
  int lost_frames = 0;                   ///< in a row, before the current one
  ResidualScale residual_scale;          ///< what the residuals of the frames so far showed
  std::int64_t reference_ns = 0;         ///< the instant that they were cut at
  std::vector<TrackedCentre> survivors;  ///< where the good ones of them are in the current frame
};

/// A recording that starts in motion starts with a velocity that nobody knows. The first two frames tell it,
/// so they are processed again with it: the first frame is compensated properly, and the second one predicted
/// well.
Result<FrameReport> Pipeline::State::process(const RgbdFrame& frame) {
  if (!estimate) {
    first_frame = frame;
    return process_once(frame);
  }
  Result<FrameReport> report = process_once(frame);
  if (first_frame && report && report->status != FrameStatus::lost)
    report = restart_in_motion(frame, report->stages);
  first_frame.reset();
  return report;
}

/// so_far: what the second frame has taken; the report has all of its time and that of the first one again.
Result<FrameReport> Pipeline::State::restart_in_motion(const RgbdFrame& second, StageTimes so_far) {
  initial_motion = estimate->mean;
  estimate.reset();
  model = TsdfVolume(config.tsdf);
  keyframes = Keyframes(rig.camera);
  survivors.clear();
  residual_scale = {};
  const Result<FrameReport> first = process_once(*first_frame);
  if (!first) return first;
  Result<FrameReport> again = process_once(second);
  if (!again) return again;
  so_far.add(first->stages);
  so_far.add(again->stages);
  again->stages = so_far;
  return again;
}

/// One frame of the paper: Sec. 2.2.1 (prediction), 2.1 and 2.2.2 (deformation, iterated update), 2.3
/// (fusion, refresh).
Result<FrameReport> Pipeline::State::process_once(const RgbdFrame& frame) {
  FrameReport report;
  report.timestamp_ns = frame.timestamp_ns;
  report.capture_ns = frame.capture_ns();
  check(!estimate || frame.capture_ns() > timestamp_ns, "frames come in the order of time");

  const bool first = !estimate.has_value();
  const Result<GaussianState> predicted = predict(frame.capture_ns(), report);  // Eqs. 8-14
  if (!predicted) return tl::unexpected(predicted.error());
  if (!is_valid(*predicted)) {
    leave_out(frame, report);
    return report;
  }
  prepare(frame, predicted->mean, report);

  const FrameStatus status = locate(*predicted, report);
  const bool lost = status == FrameStatus::lost;
  if (lost || first) estimate = *predicted;  // a lost frame keeps the prediction
  lost_frames = lost ? lost_frames + 1 : 0;
  timestamp_ns = frame.capture_ns();
  // What has come to stand before many patches is no part of the scene, and patches cut from it would lead
  // astray; what stays there for a second is.
  constexpr int kMostOccludedFrames = 30;
  occluded_frames = report.health == FrameHealth::occluded ? occluded_frames + 1 : 0;
  const bool trusted = !lost && (occluded_frames == 0 || occluded_frames > kMostOccludedFrames);
  if (trusted && compensates(frame) && moved_otherwise(*predicted)) prepare(frame, estimate->mean, report);
  report.status = status;

  if (trusted) {
    prepare_color(frame, report);
    const Result<void> fused = fuse(report);  // Sec. 2.3: M_k(X)
    if (!fused) return tl::unexpected(fused.error());
    refresh(report);  // Sec. 2.3: patch update
    keep_place(report);
  }
  describe_state(report);
  return report;
}

/// The prediction is not of this world: the frame is lost, and the next one starts from what the velocity
/// before says.
void Pipeline::State::leave_out(const RgbdFrame& frame, FrameReport& report) {
  report.health = FrameHealth::diverged;
  report.reason = fmt::format("{}: the prediction from the inertial samples since the last frame is not finite",
                              to_string(report.health));
  if (!estimate) return;
  const double since_s = seconds_between(timestamp_ns, frame.capture_ns());
  estimate = predict_by_constant_velocity(*estimate, since_s, config.motion).state;
  ++lost_frames;
  occluded_frames = 0;
  timestamp_ns = frame.capture_ns();
  describe_state(report);
}

void Pipeline::State::describe_state(FrameReport& report) const {
  report.T_world_camera = T_world_camera();
  report.estimate = in_first_camera_world(*estimate);
  report.velocity_world_mps = estimate->mean.velocity_world_mps;
  report.angular_velocity_radps = estimate->mean.angular_velocity_imu_radps;
  report.model_blocks = model.block_count();
}

FrameStatus Pipeline::State::locate(const GaussianState& predicted, FrameReport& report) {
  if (!estimate) return FrameStatus::initialised;
  // As after a gap, nobody knows how fast a recording begins.
  const bool after_gap = lost_frames > 0 || first_frame.has_value();
  if (track(predicted, after_gap, report)) return FrameStatus::tracked;  // Eqs. 1-5 and 15-23
  return relocalise(predicted, report) ? FrameStatus::relocalised : FrameStatus::lost;
}

CameraVelocity Pipeline::State::camera_velocity(const FilterState& motion) const {
  const Matrix3d R_camera_imu = rig.T_imu_camera.rotation_matrix().transpose();
  const Vector3d& rate_imu = motion.angular_velocity_imu_radps;
  const Vector3d velocity_imu = motion.T_world_imu.rotation.conjugate() * motion.velocity_world_mps +
                                rate_imu.cross(rig.T_imu_camera.translation);
  return {R_camera_imu * rate_imu, R_camera_imu * velocity_imu};
}

/// How far the image centre moves during an exposure, by rotation alone (depth is of the next frame).
double Pipeline::State::predicted_blur_px(const FilterState& motion) const {
  return rig.camera.fx_px * camera_velocity(motion).angular_radps.head<2>().norm() * config.motion.exposure_s;
}

/// True if the update changed the velocity so much that a frame compensated by the prediction is off by some
/// tenths of a pixel: then the model and the next patches deserve a better one.
bool Pipeline::State::moved_otherwise(const GaussianState& predicted) const {
  constexpr double kTurnRadps = 0.05;  // x 13 ms (half a read-out) x 520 px: a third of a pixel
  constexpr double kMoveMps = 0.05;
  const FilterState& now = estimate->mean;
  return (now.angular_velocity_imu_radps - predicted.mean.angular_velocity_imu_radps).norm() > kTurnRadps ||
         (now.velocity_world_mps - predicted.mean.velocity_world_mps).norm() > kMoveMps;
}

void Pipeline::State::prepare(const RgbdFrame& frame, const FilterState& motion, FrameReport& report) {
  const StageClock clock(report, Stage::preprocess);
  if (compensates(frame)) {
    prepared.velocity = camera_velocity(motion);
    compensate_motion(frame, rig.camera, rig.timing, prepared.velocity, workers, prepared.frame);
  } else {
    prepared.frame = frame;
  }
  build_pyramid(prepared.frame.grey, config.patches.levels, prepared.pyramid);
  gate_depth(prepared.frame.depth_m, config.depth, prepared.ungated_depth_m);
  std::swap(prepared.frame.depth_m, prepared.ungated_depth_m);
}

bool Pipeline::State::compensates(const RgbdFrame& frame) const {
  return config.terms.motion_compensation && needs_compensation(frame, rig.timing);
}

/// Colour serves the model alone, so it waits until the frame is to be fused.
void Pipeline::State::prepare_color(const RgbdFrame& frame, FrameReport& report) {
  if (!compensates(frame)) return;
  const StageClock clock(report, Stage::preprocess);
  compensate_color(frame, rig.camera, rig.timing, prepared.velocity, prepared.ungated_depth_m, workers,
                   prepared.frame.color);
}

Result<GaussianState> Pipeline::State::predict(std::int64_t now_ns, FrameReport& report) const {
  const StageClock clock(report, Stage::predict);
  const bool inertial = config.terms.prior == Prior::imu;
  if (!estimate) {
    Result<GaussianState> initial = inertial ? initialise_with_imu(imu, now_ns, rig, config.initialisation)
                                             : initialise_without_imu(config.initialisation);
    // Only the means: the frames that told them are about to be used as measurements.
    if (initial && initial_motion) {
      initial->mean.velocity_world_mps = initial_motion->velocity_world_mps;
      if (!inertial) initial->mean.angular_velocity_imu_radps = initial_motion->angular_velocity_imu_radps;
    }
    return initial;
  }
  if (!inertial) {
    return predict_by_constant_velocity(*estimate, seconds_between(timestamp_ns, now_ns), config.motion)
        .state;
  }
  const FilterState& x = estimate->mean;
  const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * x.imu_time_offset_s));
  const Result<PreintegratedImu> increments =
      preintegrate(imu, timestamp_ns + offset_ns, now_ns + offset_ns, x.gyroscope_bias_radps,
                   x.accelerometer_bias_mps2, rig.imu_noise);
  if (!increments) return tl::unexpected(increments.error());
  return predict_by_imu(*estimate, *increments, rig.imu_noise, config.motion).state;
}

/// The patches found something else than themselves.
bool Pipeline::State::settled_wrongly(const FrameReport& report) const {
  // Of well aligned patches it is about 1 at most: photometric.noise_grey is generous, and a lost frame makes
  // the learnt noise no less than that. Of those on wrong corners it is 3 to 4. How many patches agree says
  // less: until the noise is learnt, a sensor's depth alone may fail the gate.
  constexpr double kMostChi2 = 2.5;
  return config.terms.photometric_weight > 0 && report.chi2_photometric > kMostChi2;
}

/// after_gap: the prediction may be so far off that patches settle on the wrong corners.
bool Pipeline::State::track(const GaussianState& prior, bool after_gap, FrameReport& report) {
  const StageClock clock(report, Stage::update);
  const ObservedFrame observed{prepared.pyramid, prepared.frame.depth_m};
  measurement.observe(observed, patches, residual_scale);
  const IekfResult result = iekf_update(prior, measurement, config.iekf);
  if (!is_valid(result.posterior)) {
    report.health = FrameHealth::diverged;
    report.reason = fmt::format("{}: the update is not finite", to_string(report.health));
    return false;
  }
  describe_update(measurement, result, patches, report);
  report.blur_px = predicted_blur_px(prior.mean);
  report.health = judge_health(observed, measurement.outcomes(), report.blur_px, config);

  const bool too_few = report.patches_accepted < config.iekf.min_patches;
  const bool astray = after_gap && config.terms.relocalisation && settled_wrongly(report);
  if (too_few || astray) {
    report.reason =
        too_few ? fmt::format("{}: {} of {} patches were usable (iekf.min_patches = {})",
                              to_string(report.health), report.patches_accepted, report.patches,
                              config.iekf.min_patches)
                : fmt::format("after a gap the patches do not fit: {:.1f} times the variance of their noise",
                              report.chi2_photometric);
    // A light or a blur that the learnt noise does not allow must not lock every frame out.
    residual_scale = {std::max(1.0, residual_scale.photometric), std::max(1.0, residual_scale.geometric)};
    return false;
  }
  report.evidence = PoseEvidence{reference_ns, prior.mean.T_world_imu_reference,
                                 result.posterior.mean.T_world_imu, result.measurement};
  estimate = result.posterior;
  if (report.health != FrameHealth::occluded)
    residual_scale = followed_scale(residual_scale, measurement.outcomes(), config);
  survivors.clear();
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const PatchOutcome& outcome = measurement.outcomes()[p];
    if (outcome.accepted && outcome.mean_error_grey <= config.patches.max_mean_error) {
      survivors.push_back({outcome.centre_px, patches[p].age + 1});
    }
  }
  return true;
}

/// The frame may be one that a lost tracker is found by.
void Pipeline::State::keep_place(FrameReport& report) {
  if (!config.terms.relocalisation) return;
  const StageClock clock(report, Stage::refresh);
  keyframes.offer(prepared.frame.grey, prepared.frame.depth_m, T_world_camera(), timestamp_ns,
                  predicted_blur_px(estimate->mean));
}

/// Looks for the frame among those seen before, and tracks it from there with their patches.
bool Pipeline::State::relocalise(const GaussianState& prediction, FrameReport& report) {
  if (!config.terms.relocalisation || report.health == FrameHealth::dark) return false;
  std::optional<StageClock> clock(std::in_place, report, Stage::update);
  const std::optional<FoundPlace> found = keyframes.find(prepared.frame.grey);
  if (!found) return false;

  const Keyframe& keyframe = keyframes[found->keyframe];
  const RecognisedPlace place = recognised_place(*found, keyframe, rig.T_imu_camera);
  // Repeating texture looks like another place: what the motion so far rules out is none. The longer the
  // tracker is lost, the less it rules out.
  constexpr double kMostContradiction = 25;  // five standard deviations, root mean square of six axes
  if (!(contradiction(prediction, place) <= kMostContradiction)) return false;

  const std::vector<GreyImage> pyramid = build_pyramid(keyframe.grey, config.patches.levels);
  const DepthImage depth_m = keyframe.depth.unpacked_m();
  const ReferenceFrame reference{pyramid, depth_m, rig.camera, keyframe.T_world_camera};
  std::vector<Patch> patches_before =
      std::exchange(patches, refresh_patches(reference, model, {}, config, workers));
  const std::int64_t reference_before_ns = std::exchange(reference_ns, keyframe.timestamp_ns);
  clock.reset();  // track() has its own

  const InitialisationConfig& initial = config.initialisation;
  const bool gyroscope = config.terms.prior == Prior::imu;
  const UnknownMotion unknown{initial.moving_velocity_sigma_mps,
                              gyroscope ? 0.0 : initial.angular_velocity_sigma_radps};
  FrameReport again;
  again.timestamp_ns = report.timestamp_ns;
  again.capture_ns = report.capture_ns;
  again.stages = report.stages;
  const GaussianState prior = resumed(prediction, place, unknown);
  if (!is_valid(prior) || !track(prior, true, again)) {
    patches = std::move(patches_before);
    reference_ns = reference_before_ns;
    report.stages = again.stages;
    return false;
  }
  report = std::move(again);
  report.pixels = {};  // the intensity error is one against the frame before
  return true;
}

Result<void> Pipeline::State::fuse(FrameReport& report) {
  const StageClock clock(report, Stage::fuse);
  return model.integrate(prepared.frame, rig.camera, T_world_camera(), config.depth, workers);
}

void Pipeline::State::refresh(FrameReport& report) {
  const StageClock clock(report, Stage::refresh);
  const ReferenceFrame reference{prepared.pyramid, prepared.frame.depth_m, rig.camera, T_world_camera()};
  refresh_patches(reference, model, survivors, config, workers, patch_workspace, patches);
  reference_ns = timestamp_ns;
  const double share = fused_share(model, patches, reference, config.depth);
  estimate = anchored(*estimate, {share, config.motion.drift_factor});
}

Pipeline::Pipeline(const Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
                   const Workers& workers)
    : state_(std::make_unique<State>(config, rig, imu, workers)) {}
Pipeline::~Pipeline() = default;

Result<FrameReport> Pipeline::process(const RgbdFrame& frame) { return state_->process(frame); }

const TsdfVolume& Pipeline::model() const { return state_->model; }

TsdfVolume Pipeline::take_model() && {
  const std::unique_ptr<State> last = std::move(state_);
  return std::move(last->model);
}

}  // namespace fusebench
