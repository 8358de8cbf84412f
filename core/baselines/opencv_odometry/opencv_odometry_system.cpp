#include "core/baselines/opencv_odometry/opencv_odometry_system.hpp"

#include <opencv2/core/utility.hpp>
#include <optional>
#include <utility>

namespace fusebench::baselines::opencv_odometry {

OpencvOdometrySystem::OpencvOdometrySystem(config::OdometryMethod method, const config::DepthConfig& depth,
                                           const config::TsdfConfig& tsdf, const SensorRig& rig,
                                           const Workers& workers)
    : depth_(depth),
      camera_(rig.camera),
      workers_(workers),
      odometry_(method, camera_),
      T_world_camera_(rig.first_camera()),
      model_(tsdf) {
  cv::setNumThreads(workers.threads());
}

Result<health::FrameOutcome> OpencvOdometrySystem::process(const RgbdFrame& frame) {
  health::FrameOutcome outcome;
  outcome.timestamp_ns = frame.timestamp_ns;
  outcome.capture_ns = frame.capture_ns();
  {
    const health::StageClock clock(outcome.stages, health::Stage::update);
    odometry_.receive(frame);
    const bool first = !odometry_.keeps_one();
    const std::optional<SE3> motion = first ? SE3{} : odometry_.motion();
    if (motion) {
      T_world_camera_ = T_world_camera_ * *motion;
      odometry_.keep_received();
      outcome.status = first ? health::FrameStatus::initialised : health::FrameStatus::tracked;
    } else {
      outcome.reason = "the library found no motion since the last frame that it tracked";
    }
  }
  outcome.T_world_camera = T_world_camera_;
  if (outcome.status != health::FrameStatus::lost) {
    const health::StageClock clock(outcome.stages, health::Stage::fuse);
    auto fused = model_.integrate(frame, camera_, T_world_camera_, depth_, workers_);
    if (!fused) return tl::unexpected(fused.error());
  }
  outcome.model_blocks = model_.block_count();
  return outcome;
}

system::Surface OpencvOdometrySystem::take_surface() { return std::move(model_); }

}  // namespace fusebench::baselines::opencv_odometry
