#include "tests/bench/peers/opencv_odometries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <opencv2/core/version.hpp>
#include <opencv2/rgbd/depth.hpp>
#include <utility>

namespace fusebench::peers {

namespace {

using cv::rgbd::FastICPOdometry;
using cv::rgbd::Odometry;
using cv::rgbd::OdometryFrame;

/// The class filters and differentiates both frames of a pair anew. Each frame is enough once.
class RememberingFastIcp final : public FastICPOdometry {
 public:
  using FastICPOdometry::FastICPOdometry;
  cv::Size prepareFrameCache(cv::Ptr<OdometryFrame>& frame, int cache_type) const override {
    if (frame->pyramidCloud.empty()) FastICPOdometry::prepareFrameCache(frame, cache_type);
    return frame->depth.size();
  }
};

/// As OpenCV's sample odometry_evaluation.cpp uses them: the pyramids of a frame serve for two pairs, and
/// pixels without depth are NaN.
class OpencvOdometry final : public Contestant {
 public:
  explicit OpencvOdometry(cv::Ptr<Odometry> odometry) : odometry_(std::move(odometry)) {}

  void receive(const ContestFrame& frame) override {
    before_ = std::exchange(now_, cv::makePtr<OdometryFrame>());
    // Copies: the frame does not outlive the call.
    const GreyImage& grey = frame.frame.grey;
    now_->image = cv::Mat(cv::Size(grey.width, grey.height), CV_8UC1);
    std::copy(grey.data.begin(), grey.data.end(), now_->image.ptr<std::uint8_t>());
    const DepthImage& depth_m = frame.frame.depth_m;
    now_->depth = cv::Mat(cv::Size(depth_m.width, depth_m.height), CV_32FC1);
    std::copy(depth_m.data.begin(), depth_m.data.end(), now_->depth.ptr<float>());
    now_->depth.setTo(std::numeric_limits<float>::quiet_NaN(), now_->depth == 0);
  }

  void work() override { found_ = before_ && odometry_->compute(now_, before_, Rt_); }

  [[nodiscard]] std::optional<SE3> motion() const override {
    if (!found_) return std::nullopt;
    const cv::Matx44d matrix(Rt_);
    Matrix3d R_before_now;
    Vector3d translation_m;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) R_before_now(row, column) = matrix(row, column);
      translation_m(row) = matrix(row, 3);
    }
    return SE3{Quaterniond(R_before_now).normalized(), translation_m};
  }

 private:
  cv::Ptr<Odometry> odometry_;
  cv::Ptr<OdometryFrame> before_;
  cv::Ptr<OdometryFrame> now_;
  cv::Mat Rt_;
  bool found_ = false;
};

template <class Method>
Peer peer(const char* name, const char* settings) {
  return {.name = fmt::format("OpenCV {} {}", CV_VERSION, name),
          .settings = settings,
          .package = "libopencv-contrib-dev",
          .task = Task::tracking,
          .make = [](const PinholeCamera& camera, const FieldSettings&) -> std::unique_ptr<Contestant> {
            const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
            auto method = cv::makePtr<Method>();
            method->setCameraMatrix(cv::Mat(K));
            return std::make_unique<OpencvOdometry>(method);
          }};
}

}  // namespace

std::vector<Peer> opencv_odometries() {
  return {peer<cv::rgbd::RgbdOdometry>("RgbdOdometry", ""), peer<cv::rgbd::ICPOdometry>("ICPOdometry", ""),
          peer<cv::rgbd::RgbdICPOdometry>("RgbdICPOdometry", ""),
          peer<RememberingFastIcp>("FastICPOdometry", "each frame prepared once")};
}

}  // namespace fusebench::peers
