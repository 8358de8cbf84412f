#include "core/baselines/bundlefusion/bundlefusion_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <ranges>
#include <utility>

#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::baselines::bundlefusion {

namespace {

constexpr std::size_t kFramesOfChunk = 11;   // ten, and one shared with the next chunk
constexpr std::size_t kFewestKeypoints = 5;  // a pair of frames needs more matches

config::DepthConfig keypoint_depth(config::DepthConfig depth, const config::BundlefusionConfig& config) {
  depth.min_m = config.keypoint_min_depth_m;
  depth.max_m = config.keypoint_max_depth_m;
  return depth;
}

}  // namespace

BundlefusionSystem::BundlefusionSystem(const config::BundlefusionConfig& config,
                                       const config::DepthConfig& depth, const config::TsdfConfig& tsdf,
                                       const SensorRig& rig, const Workers& workers, Replay replay)
    : config_(config),
      depth_(depth),
      keypoint_depth_(keypoint_depth(depth, config)),
      camera_(rig.camera),
      workers_(workers),
      graph_(config, workers),
      model_(tsdf),
      T_world_start_(rig.first_camera()),
      replay_(std::move(replay)) {
  cv::setNumThreads(workers.threads());
}

Result<health::FrameOutcome> BundlefusionSystem::process(const RgbdFrame& frame) {
  health::FrameOutcome outcome;
  outcome.timestamp_ns = frame.timestamp_ns;
  outcome.capture_ns = frame.capture_ns();
  frames_.push_back({frame.timestamp_ns, {}});
  View view;
  {
    const health::StageClock clock(outcome.stages, health::Stage::preprocess);
    view = view_of(frame);
  }
  const std::size_t keypoints = view.keypoints.size();
  const bool first = !chunk_;
  std::optional<SE3> T_world_camera;
  {
    const health::StageClock clock(outcome.stages, health::Stage::update);
    T_world_camera = first ? begin(std::move(view)) : follow(std::move(view));
  }
  if (T_world_camera) {
    T_world_camera_ = *T_world_camera;
    outcome.status = first       ? health::FrameStatus::initialised
                     : was_lost_ ? health::FrameStatus::relocalised
                                 : health::FrameStatus::tracked;
  } else if (keypoints < kFewestKeypoints) {
    outcome.reason = fmt::format("only {} keypoints with depth", keypoints);
  } else if (frames_.back().memberships.empty() ||
             !chunk_->T_first_camera()[frames_.back().memberships.back().place]) {
    outcome.reason = "the frame matches no frame of its chunk";
  } else {
    outcome.reason = "its chunk begins with a frame without a pose";
  }
  was_lost_ = !first && !T_world_camera;
  outcome.T_world_camera = T_world_camera_;
  return outcome;
}

View BundlefusionSystem::view_of(const RgbdFrame& frame) {
  preprocessing::gate_depth(frame.depth_m, keypoint_depth_, gated_m_);
  return {find_keypoints(frame.grey, gated_m_, camera_, config_.max_keypoints, config_.min_keypoint_scale_px),
          make_depth_cloud(gated_m_, camera_)};
}

/// Processes the first frame with enough keypoints.
std::optional<SE3> BundlefusionSystem::begin(View view) {
  if (view.keypoints.size() < kFewestKeypoints) return std::nullopt;
  T_world_first_ = T_world_start_;
  start_chunk(std::move(view), frames_.size() - 1);
  return T_world_first_;
}

/// Pose of the frame; nothing if it matches no frame, or only frames without a pose.
std::optional<SE3> BundlefusionSystem::follow(View view) {
  const std::size_t frame = frames_.size() - 1;
  frames_of_chunk_.push_back(frame);
  frames_[frame].memberships.push_back({chunks_.size(), chunk_->size()});
  const bool placed = chunk_->add(std::move(view));
  std::optional<SE3> T_world_camera;
  if (placed && T_world_first_) T_world_camera = *T_world_first_ * *chunk_->T_first_camera().back();
  if (chunk_->size() < kFramesOfChunk) return T_world_camera;
  close_chunk();
  start_next_chunk();
  return placed ? T_world_first_ : std::nullopt;
}

void BundlefusionSystem::start_chunk(View first, std::size_t frame) {
  chunk_.emplace(std::move(first), config_, workers_);
  frames_of_chunk_ = {frame};
  frames_[frame].memberships.push_back({chunks_.size(), 0});
}

void BundlefusionSystem::close_chunk() {
  ClosedChunk closed;
  if (chunk_->close()) closed.keyframe = graph_.add(chunk_->merged(camera_), T_world_first_);
  closed.T_first_camera = chunk_->T_first_camera();
  chunks_.push_back(std::move(closed));
}

/// Starts at the last placed frame of the closed chunk, or at the newest frame if only the first one was
/// placed.
void BundlefusionSystem::start_next_chunk() {
  const Poses& T_first_camera = chunks_.back().T_first_camera;
  std::size_t shared = chunk_->last_placed();
  if (shared == 0) {
    shared = chunk_->size() - 1;
    T_world_first_.reset();
  } else {
    if (const auto T_world = T_world_chunk(chunks_.size() - 1)) T_world_first_ = T_world;
    if (T_world_first_) T_world_first_ = *T_world_first_ * *T_first_camera[shared];
  }
  start_chunk(chunk_->take(shared), frames_of_chunk_[shared]);
}

/// Pose of the chunk's first frame, by the graph.
std::optional<SE3> BundlefusionSystem::T_world_chunk(std::size_t chunk) const {
  const auto keyframe = chunks_[chunk].keyframe;
  return keyframe ? graph_.T_world_keyframe()[*keyframe] : std::nullopt;
}

Result<std::optional<Trajectory>> BundlefusionSystem::revise() {
  if (chunk_) {
    close_chunk();
    chunk_.reset();
  }
  graph_.finish();
  Trajectory final_trajectory;
  for (const KnownFrame& frame : frames_) {
    if (const auto T_world_camera = final_pose(frame))
      final_trajectory.push_back({frame.timestamp_ns, *T_world_camera});
  }
  if (final_trajectory.empty()) return std::nullopt;
  const auto fused = replay_([&](const RgbdFrame& frame) { return fuse(frame, final_trajectory); });
  if (!fused) return tl::unexpected(fused.error());
  return final_trajectory;
}

/// Pose by the latest chunk that has one.
std::optional<SE3> BundlefusionSystem::final_pose(const KnownFrame& frame) const {
  for (const Membership& membership : frame.memberships | std::views::reverse) {
    const auto T_world = T_world_chunk(membership.chunk);
    const auto& T_first_camera = chunks_[membership.chunk].T_first_camera[membership.place];
    if (T_world && T_first_camera) return *T_world * *T_first_camera;
  }
  return std::nullopt;
}

/// Fuses the frame if it has a final pose.
Result<void> BundlefusionSystem::fuse(const RgbdFrame& frame, const Trajectory& final_trajectory) {
  const auto pose =
      std::ranges::lower_bound(final_trajectory, frame.timestamp_ns, {}, &StampedPose::timestamp_ns);
  if (pose == final_trajectory.end() || pose->timestamp_ns != frame.timestamp_ns) return {};
  return model_.integrate(frame, camera_, pose->T_world_camera, depth_, workers_);
}

system::Surface BundlefusionSystem::take_surface() { return std::move(model_); }

}  // namespace fusebench::baselines::bundlefusion
