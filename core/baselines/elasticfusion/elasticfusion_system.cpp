#include "core/baselines/elasticfusion/elasticfusion_system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/baselines/elasticfusion/surfels/surfel_cloud.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_measure.hpp"
#include "core/baselines/elasticfusion/tracking/rotation_start.hpp"

namespace fusebench::baselines::elasticfusion {

namespace {

constexpr double kDense = 0.75;  // sparser views are filled with the previous frame
constexpr int kRotationLevel = 2;
// Limits of a bad fit for an image of 640x480, and the number of consecutive bad frames until the camera is
// lost.
constexpr double kMostError_m = 1e-4;
constexpr double kMostVariance = 1e-4;
constexpr int kBadFramesUntilLost = 10;

bool has_depth(const surfels::LiveFrame& live) {
  return std::ranges::any_of(live.normal.z.data, [](float normal_z) { return normal_z != 0; });
}

}  // namespace

ElasticfusionSystem::ElasticfusionSystem(const config::Config& config, const SensorRig& rig,
                                         std::span<const ImuSample> imu, const Workers& workers)
    : config_(config),
      rig_(rig),
      camera_(rig.camera),
      workers_(workers),
      fusion_(camera_, static_cast<float>(config.elasticfusion.stable_confidence),
              config.elasticfusion.time_window, workers),
      tracker_(config_.elasticfusion, workers),
      loops_(config.elasticfusion, camera_, workers),
      T_world_camera_(rig.first_camera()) {
  if (config_.elasticfusion.use_imu) inertial_.emplace(config_, rig_, imu);
}

Result<health::FrameOutcome> ElasticfusionSystem::process(const RgbdFrame& frame) {
  health::FrameOutcome outcome;
  outcome.timestamp_ns = frame.timestamp_ns;
  outcome.capture_ns = frame.capture_ns();
  surfels::LiveFrame live;
  {
    const health::StageClock clock(outcome.stages, health::Stage::preprocess);
    live = surfels::make_live_frame(frame, camera_, config_.depth, config_.elasticfusion.defects, workers_);
  }
  if (!has_depth(live)) {
    outcome.reason = "no depth was measured within the limits";
    outcome.T_world_camera = T_world_camera_;
    return outcome;
  }
  if (auto done = predict(outcome.capture_ns); !done) return tl::unexpected(done.error());
  tracking::LivePyramid levels;
  {
    const health::StageClock clock(outcome.stages, health::Stage::update);
    levels = tracking::live_pyramid(live, camera_, workers_);
  }
  Quality quality = Quality::good;
  if (frames_ == 0) {
    outcome.status = health::FrameStatus::initialised;
  } else {
    quality = follow(live, levels, outcome);
  }
  if (outcome.status != health::FrameStatus::lost)
    poses_.push_back({frame.timestamp_ns, frames_, T_world_camera_});
  if (quality == Quality::good) fuse(live, outcome.stages);
  render(outcome.stages);
  if (quality == Quality::good) close_loops(live, outcome.stages);
  before_ = {std::move(live), std::move(levels[kRotationLevel])};
  ++frames_;
  outcome.T_world_camera = T_world_camera_;
  return outcome;
}

/// Predicts by the inertial samples, if they are used.
Result<void> ElasticfusionSystem::predict(std::int64_t capture_ns) {
  if (!inertial_) return {};
  return frames_ == 0 ? inertial_->start(capture_ns) : inertial_->predict(capture_ns);
}

/// Tracks the frame or, if the camera is lost, relocalises it. Returns whether it can be fused.
ElasticfusionSystem::Quality ElasticfusionSystem::follow(const surfels::LiveFrame& live,
                                                         const tracking::LivePyramid& levels,
                                                         health::FrameOutcome& outcome) {
  const bool was_lost = bad_frames_ > kBadFramesUntilLost;
  const SE3 T_world_before = T_world_camera_;
  if (was_lost) find_again(live, outcome.stages);
  const tracking::TrackedMotion motion = track(levels, outcome.stages);
  T_before_camera_ = motion.T_view_camera;
  T_world_camera_ = T_world_camera_ * motion.T_view_camera;
  outcome.status = health::FrameStatus::tracked;
  if (!config_.elasticfusion.relocalise || fits(motion)) {
    if (was_lost) outcome.status = health::FrameStatus::relocalised;
    bad_frames_ = 0;
    return Quality::good;
  }
  ++bad_frames_;
  outcome.status = health::FrameStatus::lost;
  outcome.reason = was_lost ? "the camera is lost, and the frame matches no stored place"
                            : "its depth fits the model badly, or too little of it";
  if (was_lost) T_world_camera_ = T_world_before;
  return Quality::bad;
}

tracking::TrackedMotion ElasticfusionSystem::track(const tracking::LivePyramid& levels,
                                                   health::StageTimes& stages) {
  const health::StageClock clock(stages, health::Stage::update);
  if (before_ && view_.share() < kDense) fill_in(before_->live, view_);
  const tracking::ViewPyramid model = tracking::view_pyramid(view_, config_.elasticfusion.defects);
  SE3 T_view_start;
  if (inertial_) {
    const InertialTracking::Term term(*inertial_, view_.T_world_camera);
    T_view_start = view_.T_world_camera.inverse() * inertial_->T_world_camera();
    tracking::TrackedMotion motion = tracker_.track(levels, model, T_view_start, &term);
    inertial_->correct(view_.T_world_camera, motion.T_view_camera, motion.images);
    return motion;
  }
  if (before_ && config_.elasticfusion.rotation_start)
    T_view_start.rotation = tracking::rotation_between(before_->small, levels[kRotationLevel]);
  return tracker_.track(levels, model, T_view_start);
}

bool ElasticfusionSystem::fits(const tracking::TrackedMotion& motion) const {
  const double size = static_cast<double>(camera_.width_px * camera_.height_px) / (640.0 * 480.0);
  return !motion.was_dropped && motion.matches > 0 && motion.error_m < kMostError_m / std::sqrt(size) &&
         motion.variance() <= kMostVariance / size;
}

/// Relocalises by ferns.
void ElasticfusionSystem::find_again(const surfels::LiveFrame& live, health::StageTimes& stages) {
  std::optional<SE3> T_world_camera;
  {
    const health::StageClock clock(stages, health::Stage::predict);
    T_world_camera = loops_.relocate(live, view_, frames_);
  }
  if (!T_world_camera) return;
  T_world_camera_ = *T_world_camera;
  if (inertial_) inertial_->move_to(T_world_camera_);
  before_.reset();  // the previous frame has another pose
  render(stages);
}

void ElasticfusionSystem::fuse(const surfels::LiveFrame& live, health::StageTimes& stages) {
  const health::StageClock clock(stages, health::Stage::fuse);
  const surfels::FusedPose pose{T_world_camera_, frames_, surfels::weight_of_motion(T_before_camera_)};
  if (frames_ == 0) {
    fusion_.start(live, pose, map_);
  } else {
    fusion_.fuse(live, pose, map_);
  }
}

void ElasticfusionSystem::close_loops(const surfels::LiveFrame& live, health::StageTimes& stages) {
  bool closed = false;
  {
    const health::StageClock clock(stages, health::Stage::predict);
    closed = loops_.close(live, view_, frames_, map_, poses_);
  }
  if (!closed) return;
  T_world_camera_ = poses_.back().T_world_camera;
  if (inertial_) inertial_->move_to(T_world_camera_);
  render(stages);
}

void ElasticfusionSystem::render(health::StageTimes& stages) {
  const health::StageClock clock(stages, health::Stage::refresh);
  const surfels::SurfelChoice stable{frames_, config_.elasticfusion.time_window, true,
                                     static_cast<float>(config_.elasticfusion.stable_confidence)};
  renderer_.render(map_, camera_, T_world_camera_, stable, workers_, view_);
}

Result<std::optional<Trajectory>> ElasticfusionSystem::revise() {
  if (loops_.local_loops() + loops_.global_loops() == 0) return std::nullopt;
  Trajectory trajectory;
  for (const deformation::TimedPose& pose : poses_)
    trajectory.push_back({pose.timestamp_ns, pose.T_world_camera});
  return trajectory;
}

system::Surface ElasticfusionSystem::take_surface() {
  Mesh cloud = surfels::surfel_cloud(map_, static_cast<float>(config_.elasticfusion.stable_confidence));
  map_ = {};
  return cloud;
}

}  // namespace fusebench::baselines::elasticfusion
