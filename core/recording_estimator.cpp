#include "core/recording_estimator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/config/config.hpp"
#include "core/filter/moved_state.hpp"
#include "core/filter/pose_clones.hpp"
#include "core/map_segments.hpp"
#include "core/pipeline.hpp"
#include "core/prediction/initialisation.hpp"
#include "core/recording_start.hpp"
#include "core/tracking_state.hpp"

namespace fusebench::core {

namespace {

/// Loops are of the map alone.
config::Config config_of_segment(config::Config config) {
  config.loops.mode = config::LoopMode::off;
  return config;
}

/// Constant velocity is of the camera: without an IMU its place and orientation must not matter either.
SensorRig rig_for(const config::TermsConfig& terms, SensorRig rig) {
  if (terms.prior == config::Prior::constant_velocity) rig.T_imu_camera = SE3{};
  return rig;
}

}  // namespace

struct RecordingEstimator::State {
  State(const config::Config& config_in, const SensorRig& rig_in, std::span<const ImuSample> imu,
        const Workers& workers)
      : config(config_in),
        segment_config(config_of_segment(config_in)),
        rig(rig_for(config.terms, rig_in)),
        pipeline(config, rig, imu, workers, std::make_unique<Tracking>(config, rig)) {}

  Result<health::FrameReport> process(const RgbdFrame& frame);
  Result<health::FrameReport> process_second_again(const RgbdFrame& second);
  Result<health::FrameReport> process_located(const RgbdFrame& frame);
  void restart(Beginning beginning);

  Result<health::FrameReport> look_for_map(const RgbdFrame& frame, health::FrameReport report);
  [[nodiscard]] bool may_begin_segment(const health::FrameReport& report) const;
  Result<health::FrameReport> begin_segment(const RgbdFrame& frame, health::FrameReport report);
  void leave_segment();

  Result<void> correct_by_loops();
  [[nodiscard]] MapSegments::CorrectedPose corrected_pose() const;
  [[nodiscard]] Trajectory revised_trajectory() const;
  [[nodiscard]] const Tracking& of_map() const { return map ? *map : pipeline.tracking(); }

  config::Config config;
  config::Config segment_config;
  SensorRig rig;
  Pipeline pipeline;
  RecordingStart start{config.initialisation};
  std::optional<RgbdFrame> first_frame;  ///< until the second one was processed
  MapSegments segments;
  std::unique_ptr<Tracking> map;                   ///< while a segment is open
  std::optional<filter::GaussianState> corrected;  ///< by a loop, to go on with once the model is there again
  bool map_is_corrected = false;                   ///< by a loop, at least once
};

void RecordingEstimator::State::restart(Beginning beginning) {
  std::ignore = pipeline.exchange(std::make_unique<Tracking>(config, rig, std::move(beginning)));
  map.reset();
  segments = {};
}

/// From the first frame on, as RecordingStart says.
Result<health::FrameReport> RecordingEstimator::State::process(const RgbdFrame& frame) {
  Result<health::FrameReport> report = process_located(frame);
  if (!report) return report;
  StartAction action = start.judge(*report);
  if (action == StartAction::start_again) {
    health::StageTimes so_far = report->stages;
    report = process_second_again(frame);
    if (!report) return report;
    so_far.add(report->stages);
    report->stages = so_far;
    action = start.judge(*report);
  }
  if (action == StartAction::start_here) {
    health::StageTimes so_far = report->stages;
    restart({});
    report = process_located(frame);
    if (!report) return report;
    so_far.add(report->stages);
    report->stages = so_far;
    action = start.judge(*report);
    if (action == StartAction::go_on)
      report->reason = "started again: hardly a frame could be tracked from the first start";
  }
  const bool is_first = report->status == health::FrameStatus::initialised;
  if (action == StartAction::wait) {
    report->status = health::FrameStatus::lost;
    report->reason = fmt::format("waiting for a usable first frame: {}", health::to_string(report->health));
    report->model_blocks = 0;
    restart({});
  }
  first_frame = is_first ? std::optional(frame) : std::nullopt;
  return report;
}

/// The first two frames, with the velocity that they have told.
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

/// In the map, or in a segment.
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
  if (const auto done = correct_by_loops(); !done) return tl::unexpected(done.error());
  return report;
}

/// Relocalises a frame of the open segment in the map; where that succeeds, the segment is joined, and the
/// frame is one of the map.
Result<health::FrameReport> RecordingEstimator::State::look_for_map(const RgbdFrame& frame,
                                                                    health::FrameReport report) {
  const Tracking& in_segment = pipeline.tracking();
  const bool due =
      report.status == health::FrameStatus::lost || in_segment.frames % config.segments.search_every == 0;
  if (!due || !pipeline.novelty().complete()) return report;
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
  found->joined_segment = segments.open();
  segments.join(frame.timestamp_ns, pipeline.T_world_camera(), T_segment_camera);
  pipeline.tracking().relocalisation.adopt(segment->relocalisation,
                                           pipeline.T_world_camera() * T_segment_camera.inverse());
  return found;
}

/// The camera has been lost for a while, and its images are sound.
bool RecordingEstimator::State::may_begin_segment(const health::FrameReport& report) const {
  const Tracking& lost = pipeline.tracking();
  return config.terms.relocalisation && config.segments.begin_after_s > 0 &&
         report.status == health::FrameStatus::lost && health::is_sound(report.health) &&
         pipeline.novelty().complete() &&
         seconds_between(lost.located_ns, lost.timestamp_ns) >= config.segments.begin_after_s;
}

/// The frame becomes the first one of a new segment, unless it cannot be tracked from. An earlier segment
/// stays apart.
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

/// After the last frame.
void RecordingEstimator::State::leave_segment() {
  segments.close();
  if (map) std::ignore = pipeline.exchange(std::move(map));
}

/// The world moves, and the model has to be made again.
Result<void> RecordingEstimator::State::correct_by_loops() {
  Tracking& now = pipeline.tracking();
  const auto moved = now.loops.correct_online();
  if (!moved) return tl::unexpected(moved.error());
  if (!*moved) return {};
  map_is_corrected = true;
  corrected = filter::moved(*now.estimate, **moved);
  now.model = tsdf::TsdfVolume(config.tsdf);
  now.relocalisation.move([&](std::int64_t timestamp_ns) {
    const std::optional<SE3> joined = segments.joined_pose_near(timestamp_ns, corrected_pose());
    return joined ? *joined * rig.T_imu_camera : now.loops.corrected_pose_near(timestamp_ns);
  });
  return {};
}

/// Empty unless a loop has corrected the map.
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
                                       std::span<const ImuSample> imu, const Workers& workers)
    : state_(std::make_unique<State>(config, rig, imu, workers)) {}
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
  last.model = tsdf::TsdfVolume(state_->config.tsdf);
  return state_->revised_trajectory();
}

Result<void> RecordingEstimator::fuse_again(const RgbdFrame& frame) {
  std::optional<filter::FilterState> state;
  if (state_->map_is_corrected) state = state_->of_map().loops.corrected_state(frame.timestamp_ns);
  if (!state) state = state_->segments.fused_state(frame.timestamp_ns, state_->corrected_pose());
  if (!state) return {};
  return state_->pipeline.fuse_again(frame, *state);
}

bool RecordingEstimator::wants_frames_again() const { return state_->corrected.has_value(); }

void RecordingEstimator::resume() {
  state_->pipeline.resume(*std::exchange(state_->corrected, std::nullopt));
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
