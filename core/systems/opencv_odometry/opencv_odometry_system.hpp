// OpenCV's odometries, frame to frame, with a TSDF fused at the poses that they add up to.
#pragma once

#include "core/base/parallel.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/systems/opencv_odometry/frame_odometry.hpp"
#include "core/systems/system.hpp"

namespace fusebench::systems::opencv_odometry {

class OpencvOdometrySystem final : public System {
 public:
  /// workers must outlive it. The library's own threads are limited to as many.
  OpencvOdometrySystem(config::OdometryMethod method, const config::DepthConfig& depth,
                       const config::TsdfConfig& tsdf, const SensorRig& rig, const Workers& workers);

  /// The first frame is the first one, and the world its camera. A motion that the library does not find
  /// makes the frame lost: it is not fused, and the next one is compared with the last one that was not lost.
  /// Error run_failed: a full model.
  [[nodiscard]] Result<health::FrameOutcome> process(const RgbdFrame& frame) override;
  [[nodiscard]] Surface take_surface() override;

 private:
  config::DepthConfig depth_;
  PinholeCamera camera_;
  const Workers& workers_;
  FrameOdometry odometry_;
  SE3 T_world_camera_;  ///< of the last frame that was not lost
  tsdf::TsdfVolume model_;
};

}  // namespace fusebench::systems::opencv_odometry
