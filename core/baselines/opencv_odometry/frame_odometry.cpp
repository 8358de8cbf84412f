#include "core/baselines/opencv_odometry/frame_odometry.hpp"

#include <algorithm>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/rgbd/depth.hpp>
#include <utility>

#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::opencv_odometry {

namespace {

using cv::rgbd::Odometry;
using cv::rgbd::OdometryFrame;

/// FastICPOdometry prepares both frames of a pair each time. This class prepares each frame once.
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

struct FrameOdometry::State {
  cv::Ptr<Odometry> odometry;
  cv::Ptr<OdometryFrame> kept;
  cv::Ptr<OdometryFrame> received;
};

FrameOdometry::FrameOdometry(config::OdometryMethod method, const PinholeCamera& camera)
    : state_(std::make_unique<State>(State{odometry_of(method, camera), {}, {}})) {}
FrameOdometry::~FrameOdometry() = default;

void FrameOdometry::receive(const RgbdFrame& frame) { state_->received = odometry_frame(frame); }

std::optional<SE3> FrameOdometry::motion() {
  cv::Mat T_kept_received;
  if (!state_->kept || !state_->odometry->compute(state_->received, state_->kept, T_kept_received))
    return std::nullopt;
  return pose_of(T_kept_received);
}

bool FrameOdometry::keeps_one() const { return !state_->kept.empty(); }

void FrameOdometry::keep_received() { state_->kept = std::exchange(state_->received, {}); }

}  // namespace fusebench::baselines::opencv_odometry
