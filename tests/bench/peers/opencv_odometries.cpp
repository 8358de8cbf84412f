#include "tests/bench/peers/opencv_odometries.hpp"

#include <fmt/format.h>

#include <opencv2/core/version.hpp>

#include "core/baselines/opencv_odometry/frame_odometry.hpp"
#include "core/config/groups/systems_config.hpp"

namespace fusebench::peers {

namespace {

using baselines::opencv_odometry::FrameOdometry;

/// Each frame against the one before.
class OpencvOdometry final : public Contestant {
 public:
  OpencvOdometry(config::OdometryMethod method, const PinholeCamera& camera) : odometry_(method, camera) {}

  void receive(const ContestFrame& frame) override {
    if (received_) odometry_.keep_received();
    odometry_.receive(frame.frame);
    received_ = true;
  }
  void work() override { motion_ = odometry_.motion(); }
  [[nodiscard]] std::optional<SE3> motion() const override { return motion_; }

 private:
  FrameOdometry odometry_;
  bool received_ = false;
  std::optional<SE3> motion_;
};

template <config::OdometryMethod method>
Peer peer(const char* name, const char* settings) {
  return {.name = fmt::format("OpenCV {} {}", CV_VERSION, name),
          .settings = settings,
          .package = "libopencv-contrib-dev",
          .task = Task::tracking,
          .make = [](const PinholeCamera& camera, const FieldSettings&) -> std::unique_ptr<Contestant> {
            return std::make_unique<OpencvOdometry>(method, camera);
          }};
}

}  // namespace

std::vector<Peer> opencv_odometries() {
  return {peer<config::OdometryMethod::rgbd>("RgbdOdometry", ""),
          peer<config::OdometryMethod::icp>("ICPOdometry", ""),
          peer<config::OdometryMethod::rgbd_icp>("RgbdICPOdometry", ""),
          peer<config::OdometryMethod::fast_icp>("FastICPOdometry", "each frame prepared once")};
}

}  // namespace fusebench::peers
