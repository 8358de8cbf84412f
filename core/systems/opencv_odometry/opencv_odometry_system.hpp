// OpenCV's odometries (module rgbd), frame to frame, with a TSDF fused at the poses that they add up to.
#pragma once

#include <memory>

#include "core/base/parallel.hpp"
#include "core/config/config.hpp"
#include "core/systems/system.hpp"

namespace fusebench::systems::opencv_odometry {

class OpencvOdometrySystem final : public System {
 public:
  /// workers must outlive it. The library's own threads are limited to as many.
  OpencvOdometrySystem(const config::Config& config, const SensorRig& rig, const Workers& workers);
  ~OpencvOdometrySystem() override;

  /// The first frame with depth is the first one; the world is its camera. A motion that the library does not
  /// find makes the frame lost: it is not fused, and the next one is compared with the last one that was not
  /// lost. Error run_failed: a full model.
  [[nodiscard]] Result<health::FrameOutcome> process(const RgbdFrame& frame) override;
  [[nodiscard]] Surface take_surface() override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench::systems::opencv_odometry
