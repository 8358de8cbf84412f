#include "core/recording_estimator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/config/config.hpp"
#include "core/estimator/acceptance/fusion_gate.hpp"
#include "core/estimator/acceptance/recording_start.hpp"
#include "core/estimator/filter/moved_state.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "core/estimator/prediction/initialisation.hpp"
#include "core/pipeline.hpp"
#include "core/steps/map_segments.hpp"
#include "core/steps/tracking_state.hpp"

namespace fusebench::core {

namespace {

/// Loops are closed in the map only.
config::Config config_of_segment(config::Config config) {
  config.loops.mode = config::LoopMode::off;
  return config;
}

/// The constant-velocity model applies to the camera: without an IMU, T_imu_camera must have no effect.
SensorRig rig_for(const config::TermsConfig& terms, SensorRig rig) {
  if (terms.prior == config::Prior::constant_velocity) rig.T_imu_camera = SE3{};
  return rig;
}

}  // namespace

struct RecordingEstimator::State {
  State(const config::Config& config_in, const SensorRig& rig_in, std::span<const ImuSample> imu,
        const Workers& workers, Replay replay_in)
      : config(config_in),
        segment_config(config_of_segment(config_in)),
        rig(rig_for(config.terms, rig_in)),
        pipeline(config, rig, imu, workers, std::make_unique<Tracking>(config, rig)),
        replay(std::move(replay_in)) {}

  Result<health::FrameReport> process(const RgbdFrame& frame);
  Result<health::FrameReport> process_second_again(const RgbdFrame& second);
  Result<health::FrameReport> process_located(const RgbdFrame& frame);
  void restart(Beginning beginning);

  Result<health::FrameReport> look_for_map(const RgbdFrame& frame, health::FrameReport report);
  [[nodiscard]] bool may_begin_segment(const health::FrameReport& report) const;
  Result<health::FrameReport> begin_segment(const RgbdFrame& frame, health::FrameReport report);
  void leave_segment();

  Result<bool> correct_by_loops();
  Result<void> fuse_all_again();
  Result<void> fuse_again(const RgbdFrame& frame);
  [[nodiscard]] MapSegments::CorrectedPose corrected_pose() const;
  [[nodiscard]] Trajectory revised_trajectory() const;
  [[nodiscard]] const Tracking& of_map() const { return map ? *map : pipeline.tracking(); }

  config::Config config;
  config::Config segment_config;
  SensorRig rig;
  Pipeline pipeline;
  acceptance::RecordingStart start{config.initialisation};
  std::optional<RgbdFrame> first_frame;  ///< until the second frame is processed
  MapSegments segments;
  Replay replay;
  std::unique_ptr<Tracking> map;  ///< set while a segment is open
  bool map_is_corrected = false;  ///< by at least one loop
};

void RecordingEstimator::State::restart(Beginning beginning) {
  std::ignore = pipeline.exchange(std::make_unique<Tracking>(config, rig, std::move(beginning)));
  map.reset();
  segments = {};
}

/// Processes frames until the first one is selected by acceptance::RecordingStart, and all later ones.
Result<health::FrameReport> RecordingEstimator::State::process(const RgbdFrame& frame) {
  Result<health::FrameReport> report = process_located(frame);
  if (!report) return report;
  acceptance::StartAction action = start.judge(*report);
  if (action == acceptance::StartAction::start_again) {
    health::StageTimes so_far = report->stages;
    report = process_second_again(frame);
    if (!report) return report;
    so_far.add(report->stages);
    report->stages = so_far;
    action = start.judge(*report);
  }
  if (action == acceptance::StartAction::start_here) {
    health::StageTimes so_far = report->stages;
    restart({});
    report = process_located(frame);
    if (!report) return report;
    so_far.add(report->stages);
    report->stages = so_far;
    action = start.judge(*report);
    if (action == acceptance::StartAction::go_on)
      report->reason = "started again: too few frames were tracked from the first start";
  }
  const bool is_first = report->status == health::FrameStatus::initialised;
  if (action == acceptance::StartAction::wait) {
    report->status = health::FrameStatus::lost;
    report->reason = fmt::format("waiting for a usable first frame: {}", health::to_string(report->health));
    report->model_blocks = 0;
    restart({});
  }
  first_frame = is_first ? std::optional(frame) : std::nullopt;
  return report;
}

/// Processes the first two frames with the velocity estimated from them.
Result<health::FrameReport> RecordingEstimator::State::process_second_again(const RgbdFrame& second) {
  restart({.motion = pipeline.tracking().estimate->mean});
  const Result<health::FrameReport> first = process_located(*first_frame);
  if (!first) return first;
  Result<health::FrameReport> report = process_located(second);
  if (!report) return report;
  health::StageTimes both = first->stages;
  both.add(report->stages);
  report->stages = both;
  return report;
}

/// Processes a frame in the map or in a segment.
Result<health::FrameReport> RecordingEstimator::State::process_located(const RgbdFrame& frame) {
  Result<health::FrameReport> report = pipeline.process(frame);
  if (report && segments.open() > 0) report = look_for_map(frame, *std::move(report));
  if (report && may_begin_segment(*report)) report = begin_segment(frame, *std::move(report));
  if (!report) return report;
  report->segment = segments.open();
  if (report->status == health::FrameStatus::lost) return report;
  segments.add({report->timestamp_ns, segments.open(), report->fused, pipeline.tracking().estimate->mean});
  if (segments.open() > 0) {
    report->status = health::FrameStatus::other_segment;
    return report;
  }
  pipeline.tracking().loops.add_pose(report->timestamp_ns, report->T_world_camera);
  const Result<bool> corrected = correct_by_loops();
  if (!corrected) return tl::unexpected(corrected.error());
  report->poses_corrected = *corrected;
  return report;
}

/// Relocalises a frame of the open segment in the map. On success, joins the segment and continues in the
/// map. A segment in which the camera has been lost for some time stays separate, since the motion since then
/// is unknown.
Result<health::FrameReport> RecordingEstimator::State::look_for_map(const RgbdFrame& frame,
                                                                    health::FrameReport report) {
  const Tracking& in_segment = pipeline.tracking();
  const bool due =
      report.status == health::FrameStatus::lost || in_segment.frames % config.segments.search_every == 0;
  if (!due || !pipeline.novelty().complete()) return report;
  constexpr double kDeadReckoned_s = 0.1;  // within a few millimetres
  const bool is_connected =
      seconds_between(in_segment.located_ns, in_segment.timestamp_ns) <= kDeadReckoned_s;
  const SE3 T_segment_camera = pipeline.T_world_camera();
  const filter::GaussianState prior =
      filter::with_model_of(segments.in_map(*in_segment.estimate), *map->estimate);
  map->repeated_images = in_segment.repeated_images;
  std::unique_ptr<Tracking> segment = pipeline.exchange(std::move(map));
  Result<health::FrameReport> found = pipeline.relocalise_again(frame, prior, report);
  if (!found) return found;
  if (found->status == health::FrameStatus::lost) {
    map = pipeline.exchange(std::move(segment));
    report.stages = found->stages;
    return report;
  }
  if (!is_connected) {
    segments.close();
    return found;
  }
  found->joined_segment = segments.open();
  segments.join(frame.timestamp_ns, pipeline.T_world_camera(), T_segment_camera);
  pipeline.tracking().relocalisation.adopt(segment->relocalisation,
                                           pipeline.T_world_camera() * T_segment_camera.inverse());
  return found;
}

bool RecordingEstimator::State::may_begin_segment(const health::FrameReport& report) const {
  const Tracking& lost = pipeline.tracking();
  return acceptance::may_begin_segment(report, seconds_between(lost.located_ns, lost.timestamp_ns),
                                       pipeline.novelty().complete(), config.terms, config.segments);
}

/// Starts a new segment at this frame, unless it cannot be tracked from. An earlier segment stays separate.
Result<health::FrameReport> RecordingEstimator::State::begin_segment(const RgbdFrame& frame,
                                                                     health::FrameReport report) {
  const Tracking& lost = pipeline.tracking();
  const filter::GaussianState reckoned =
      segments.open() > 0 ? segments.in_map(*lost.estimate) : *lost.estimate;
  auto begun =
      std::make_unique<Tracking>(segment_config, rig, Beginning{.state = prediction::begun_again(reckoned)});
  begun->motion_scale = lost.motion_scale;
  begun->residual_scale = lost.residual_scale;
  begun->turned_rad = lost.turned_rad;
  std::unique_ptr<Tracking> before = pipeline.exchange(std::move(begun));
  Result<health::FrameReport> first = pipeline.process(frame);
  if (!first) return first;
  report.stages.add(first->stages);
  if (first->health != health::FrameHealth::good) {
    std::ignore = pipeline.exchange(std::move(before));
    return report;
  }
  first->stages = report.stages;
  if (!map) map = std::move(before);
  segments.begin(reckoned);
  return first;
}

/// Closes the open segment after the last frame.
void RecordingEstimator::State::leave_segment() {
  segments.close();
  if (map) std::ignore = pipeline.exchange(std::move(map));
}

/// Applies an online loop correction, if there is one: moves all poses and fuses the model again. True if it
/// did.
Result<bool> RecordingEstimator::State::correct_by_loops() {
  Tracking& now = pipeline.tracking();
  const auto moved = now.loops.correct_online();
  if (!moved) return tl::unexpected(moved.error());
  if (!*moved) return false;
  map_is_corrected = true;
  const filter::GaussianState corrected = filter::moved(*now.estimate, **moved);
  now.relocalisation.move([&](std::int64_t timestamp_ns) {
    const std::optional<SE3> joined = segments.joined_pose_near(timestamp_ns, corrected_pose());
    return joined ? *joined * rig.T_imu_camera : now.loops.corrected_pose_near(timestamp_ns);
  });
  if (const Result<void> fused = fuse_all_again(); !fused) return tl::unexpected(fused.error());
  pipeline.resume(corrected);
  return true;
}

/// Fuses the model of the map again from all its fused frames at their corrected poses.
Result<void> RecordingEstimator::State::fuse_all_again() {
  check(static_cast<bool>(replay), "an estimator that changes poses has a replay");
  pipeline.tracking().model = tsdf::TsdfVolume(config.tsdf);
  return replay([this](const RgbdFrame& frame) { return fuse_again(frame); });
}

Result<void> RecordingEstimator::State::fuse_again(const RgbdFrame& frame) {
  std::optional<filter::FilterState> state;
  if (map_is_corrected) state = of_map().loops.corrected_state(frame.timestamp_ns);
  if (!state) state = segments.fused_state(frame.timestamp_ns, corrected_pose());
  if (!state) return {};
  return pipeline.fuse_again(frame, *state);
}

/// Empty if no loop has corrected the map.
MapSegments::CorrectedPose RecordingEstimator::State::corrected_pose() const {
  if (!map_is_corrected) return {};
  return [&loops = of_map().loops](std::int64_t timestamp_ns) {
    return loops.corrected_pose_near(timestamp_ns);
  };
}

Trajectory RecordingEstimator::State::revised_trajectory() const {
  Trajectory poses = segments.trajectory(rig.T_imu_camera, !map_is_corrected, corrected_pose());
  if (!map_is_corrected) return poses;
  const Trajectory poses_of_map = of_map().loops.corrected_trajectory();
  poses.insert(poses.end(), poses_of_map.begin(), poses_of_map.end());
  std::ranges::sort(poses, {}, &StampedPose::timestamp_ns);
  return poses;
}

RecordingEstimator::RecordingEstimator(const config::Config& config, const SensorRig& rig,
                                       std::span<const ImuSample> imu, const Workers& workers, Replay replay)
    : state_(std::make_unique<State>(config, rig, imu, workers, std::move(replay))) {}
RecordingEstimator::~RecordingEstimator() = default;

Result<health::FrameReport> RecordingEstimator::process(const RgbdFrame& frame) {
  return state_->process(frame);
}

Result<std::optional<Trajectory>> RecordingEstimator::revise() {
  state_->leave_segment();
  Tracking& last = state_->pipeline.tracking();
  const Result<bool> changed = last.loops.close();
  if (!changed) return tl::unexpected(changed.error());
  state_->map_is_corrected = *changed;
  if (!*changed && !state_->segments.has_joined()) return std::nullopt;
  if (const Result<void> fused = state_->fuse_all_again(); !fused) return tl::unexpected(fused.error());
  return state_->revised_trajectory();
}

const loops::LoopClosure* RecordingEstimator::loops() const {
  const loops::LoopClosure& loops = state_->of_map().loops;
  return loops.enabled() ? &loops : nullptr;
}

const tsdf::TsdfVolume& RecordingEstimator::model() const { return state_->of_map().model; }

tsdf::TsdfVolume RecordingEstimator::take_model() && {
  const std::unique_ptr<State> last = std::move(state_);
  last->leave_segment();
  return std::move(last->pipeline.tracking().model);
}

}  // namespace fusebench::core
