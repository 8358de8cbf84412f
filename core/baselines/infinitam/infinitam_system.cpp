#include "core/baselines/infinitam/infinitam_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fusebench::baselines::infinitam {

namespace {

// until then, the tracker gives all surfaces equal weight
constexpr std::uint32_t kFramesBeforeWeights = 100;
constexpr std::uint32_t kFramesFusedAnyway = 50;    // the first frames are fused whatever their quality
constexpr int kGoodFramesAfterRelocalisation = 10;  // tracked before fusion continues

bool has_depth(const RgbdFrame& frame) {
  return std::ranges::any_of(frame.depth_m.data, [](float depth_m) { return depth_m > 0; });
}

}  // namespace

InfinitamSystem::InfinitamSystem(const config::InfinitamConfig& config, const config::DepthConfig& depth,
                                 const config::TsdfConfig& tsdf, const SensorRig& rig, const Workers& workers)
    : config_(config),
      depth_(depth),
      camera_(rig.camera),
      workers_(workers),
      model_(tsdf),
      renderer_(camera_, depth_),
      tracker_(config_, depth_, camera_, workers),
      relocaliser_(camera_, depth_, config_.defects),
      T_world_camera_(rig.first_camera()) {}

Result<health::FrameOutcome> InfinitamSystem::process(const RgbdFrame& frame) {
  health::FrameOutcome outcome;
  outcome.timestamp_ns = frame.timestamp_ns;
  outcome.capture_ns = frame.capture_ns();
  if (!has_depth(frame)) {
    outcome.reason = "no depth was measured";
    outcome.T_world_camera = T_world_camera_;
    return outcome;
  }
  FrameLevels levels;
  {
    const health::StageClock clock(outcome.stages, health::Stage::preprocess);
    levels = levels_of(frame, config_);
  }
  Quality quality = Quality::good;
  if (frames_ == 0) {
    outcome.status = health::FrameStatus::initialised;
  } else {
    const SE3 T_world_before = T_world_camera_;
    outcome.status = health::FrameStatus::tracked;
    quality = relocalise(levels, track(levels, outcome.stages), outcome);
    if (quality == Quality::failed) {
      outcome.status = health::FrameStatus::lost;
      outcome.reason = fmt::format("less than {:.0f} % of the depth pixels match the model",
                                   100 * config_.failed_inlier_share);
      if (config_.on_failure == config::InfinitamFailure::relocalise) T_world_camera_ = T_world_before;
    }
  }
  const bool fused = (quality == Quality::good || frames_ <= kFramesFusedAnyway) && unfused_good_frames_ == 0;
  if (fused) {
    if (auto done = fuse(frame, outcome.stages); !done) return tl::unexpected(done.error());
  }
  render(outcome.stages);
  before_ = std::move(levels);
  ++frames_;
  outcome.T_world_camera = T_world_camera_;
  outcome.model_blocks = model_.block_count();
  return outcome;
}

InfinitamSystem::Quality InfinitamSystem::judge(const TrackedPose& pose) const {
  if (config_.on_failure == config::InfinitamFailure::ignore) return Quality::good;
  if (pose.inlier_share >= config_.good_inlier_share) return Quality::good;
  return pose.inlier_share >= config_.failed_inlier_share ? Quality::poor : Quality::failed;
}

InfinitamSystem::Quality InfinitamSystem::track(const FrameLevels& levels, health::StageTimes& stages) {
  const health::StageClock clock(stages, health::Stage::update);
  const TrackingTarget target{view_, before_ ? &*before_ : nullptr, frames_ >= kFramesBeforeWeights};
  const TrackedPose pose = tracker_.track(levels, T_world_camera_, target);
  T_world_camera_ = pose.T_world_camera;
  return judge(pose);
}

/// Stores the frame or, after a failure, relocalises it; returns the resulting quality.
InfinitamSystem::Quality InfinitamSystem::relocalise(const FrameLevels& levels, Quality quality,
                                                     health::FrameOutcome& outcome) {
  if (config_.on_failure != config::InfinitamFailure::relocalise) return quality;
  if (quality == Quality::good && unfused_good_frames_ > 0) --unfused_good_frames_;
  const ferns::FernCode code = relocaliser_.code_of(levels.depth_m.front());
  if (quality == Quality::good && unfused_good_frames_ == 0) relocaliser_.offer(code, T_world_camera_);
  if (quality != Quality::failed) return quality;
  const SE3* const place = relocaliser_.most_similar(code);
  if (place == nullptr) return quality;
  unfused_good_frames_ = kGoodFramesAfterRelocalisation;
  T_world_camera_ = *place;
  before_.reset();  // the previous frame has another pose
  render(outcome.stages);
  quality = track(levels, outcome.stages);
  if (quality != Quality::failed) outcome.status = health::FrameStatus::relocalised;
  return quality;
}

Result<void> InfinitamSystem::fuse(const RgbdFrame& frame, health::StageTimes& stages) {
  const health::StageClock clock(stages, health::Stage::fuse);
  return model_.integrate(frame, camera_, T_world_camera_, depth_, workers_);
}

void InfinitamSystem::render(health::StageTimes& stages) {
  const health::StageClock clock(stages, health::Stage::refresh);
  renderer_.render(model_, T_world_camera_, frames_ + 1 >= kFramesBeforeWeights, workers_, view_);
}

system::Surface InfinitamSystem::take_surface() { return std::move(model_); }

}  // namespace fusebench::baselines::infinitam
