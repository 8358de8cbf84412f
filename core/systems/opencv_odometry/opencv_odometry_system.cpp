#include "core/systems/opencv_odometry/opencv_odometry_system.hpp"

#include <algorithm>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/rgbd/depth.hpp>
#include <optional>
#include <utility>

namespace fusebench::systems::opencv_odometry {

namespace {

using cv::rgbd::Odometry;
using cv::rgbd::OdometryFrame;

/// The class prepares both frames of a pair anew. Each frame is enough once.
class RememberingFastIcp final : public cv::rgbd::FastICPOdometry {
 public:
  using cv::rgbd::FastICPOdometry::FastICPOdometry;
  cv::Size prepareFrameCache(cv::Ptr<OdometryFrame>& frame, int cache_type) const override {
    if (frame->pyramidCloud.empty()) FastICPOdometry::prepareFrameCache(frame, cache_type);
    return frame->depth.size();
  }
};

cv::Ptr<Odometry> odometry_of(config::OdometryMethod method, const PinholeCamera& camera) {
  cv::Ptr<Odometry> odometry;
  switch (method) {
    case config::OdometryMethod::rgbd:
      odometry = cv::makePtr<cv::rgbd::RgbdOdometry>();
      break;
    case config::OdometryMethod::icp:
      odometry = cv::makePtr<cv::rgbd::ICPOdometry>();
      break;
    case config::OdometryMethod::rgbd_icp:
      odometry = cv::makePtr<cv::rgbd::RgbdICPOdometry>();
      break;
    case config::OdometryMethod::fast_icp:
      odometry = cv::makePtr<RememberingFastIcp>();
      break;
  }
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  odometry->setCameraMatrix(cv::Mat(K));
  return odometry;
}

/// As the library wants it: pixels without depth are NaN. Copies, since it keeps the images.
cv::Ptr<OdometryFrame> odometry_frame(const RgbdFrame& frame) {
  auto result = cv::makePtr<OdometryFrame>();
  result->image = cv::Mat(cv::Size(frame.grey.width, frame.grey.height), CV_8UC1);
  std::ranges::copy(frame.grey.data, result->image.ptr<std::uint8_t>());
  result->depth = cv::Mat(cv::Size(frame.depth_m.width, frame.depth_m.height), CV_32FC1);
  std::ranges::transform(frame.depth_m.data, result->depth.ptr<float>(), [](float depth_m) {
    return depth_m > 0 ? depth_m : std::numeric_limits<float>::quiet_NaN();
  });
  return result;
}

SE3 pose_of(const cv::Mat& matrix) {
  const cv::Matx44d m(matrix);
  Matrix3d R;
  Vector3d translation_m;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) R(row, column) = m(row, column);
    translation_m(row) = m(row, 3);
  }
  return {Quaterniond(R).normalized(), translation_m};
}

}  // namespace

struct OpencvOdometrySystem::State {
  State(const config::Config& config_in, const SensorRig& rig, const Workers& workers_in)
      : config(config_in),
        camera(rig.camera),
        workers(workers_in),
        odometry(odometry_of(config.opencv_odometry.method, camera)),
        model(config.tsdf) {}

  std::optional<SE3> motion_since_last(const cv::Ptr<OdometryFrame>& frame) {
    cv::Mat T_last_now;
    auto now = frame;
    if (!odometry->compute(now, last, T_last_now)) return std::nullopt;
    return pose_of(T_last_now);
  }

  config::Config config;
  PinholeCamera camera;
  const Workers& workers;
  cv::Ptr<Odometry> odometry;
  cv::Ptr<OdometryFrame> last;  ///< that was not lost
  SE3 T_world_camera;           ///< of it
  tsdf::TsdfVolume model;
};

OpencvOdometrySystem::OpencvOdometrySystem(const config::Config& config, const SensorRig& rig,
                                           const Workers& workers)
    : state_(std::make_unique<State>(config, rig, workers)) {
  cv::setNumThreads(workers.threads());
}
OpencvOdometrySystem::~OpencvOdometrySystem() = default;

Result<health::FrameOutcome> OpencvOdometrySystem::process(const RgbdFrame& frame) {
  health::FrameOutcome outcome;
  outcome.timestamp_ns = frame.timestamp_ns;
  outcome.capture_ns = frame.capture_ns();
  {
    const health::StageClock clock(outcome.stages, health::Stage::update);
    auto now = odometry_frame(frame);
    const bool first = !state_->last;
    const std::optional<SE3> motion = first ? SE3{} : state_->motion_since_last(now);
    if (motion) {
      state_->T_world_camera = state_->T_world_camera * *motion;
      state_->last = std::move(now);
      outcome.status = first ? health::FrameStatus::initialised : health::FrameStatus::tracked;
    } else {
      outcome.reason = "the library found no motion since the last frame that it tracked";
    }
  }
  outcome.T_world_camera = state_->T_world_camera;
  if (outcome.status != health::FrameStatus::lost) {
    const health::StageClock clock(outcome.stages, health::Stage::fuse);
    auto fused = state_->model.integrate(frame, state_->camera, state_->T_world_camera, state_->config.depth,
                                         state_->workers);
    if (!fused) return tl::unexpected(fused.error());
  }
  outcome.model_blocks = state_->model.block_count();
  return outcome;
}

Surface OpencvOdometrySystem::take_surface() { return std::move(state_->model); }

}  // namespace fusebench::systems::opencv_odometry
