// OpenCV's frame-to-frame odometries, with a TSDF fused at the accumulated poses.
#pragma once

#include "core/base/parallel.hpp"
#include "core/baselines/opencv_odometry/frame_odometry.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/system/system.hpp"

namespace fusebench::baselines::opencv_odometry {

class OpencvOdometrySystem final : public system::System {
 public:
  /// workers must outlive the system. The library is limited to the same number of threads.
  OpencvOdometrySystem(config::OdometryMethod method, const config::DepthConfig& depth,
                       const config::TsdfConfig& tsdf, const SensorRig& rig, const Workers& workers);

  /// The world is the camera frame of the first frame. If the library finds no motion, the frame is lost: it
  /// is not fused, and the next one is compared with the last tracked frame. Error run_failed: a full model.
  [[nodiscard]] Result<health::FrameOutcome> process(const RgbdFrame& frame) override;
  [[nodiscard]] system::Surface take_surface() override;

 private:
  config::DepthConfig depth_;
  PinholeCamera camera_;
  const Workers& workers_;
  FrameOdometry odometry_;
  SE3 T_world_camera_;  ///< of the last frame that was not lost
  tsdf::TsdfVolume model_;
};

}  // namespace fusebench::baselines::opencv_odometry
