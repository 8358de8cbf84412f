// ElasticFusion's method on the processor (Whelan et al., "ElasticFusion: Dense SLAM Without A Pose Graph",
// RSS 2015, and "ElasticFusion: Real-time dense SLAM and light source estimation", IJRR 2016): a map of
// surfels, tracked against by colour and depth together, and bent when places are seen again.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/config/config.hpp"
#include "core/systems/elasticfusion/deformation/loop_closer.hpp"
#include "core/systems/elasticfusion/inertial_tracking.hpp"
#include "core/systems/elasticfusion/surfels/surfel_fusion.hpp"
#include "core/systems/elasticfusion/surfels/surfel_view.hpp"
#include "core/systems/elasticfusion/tracking/camera_tracker.hpp"
#include "core/systems/system.hpp"

namespace fusebench::systems::elasticfusion {

class ElasticfusionSystem final : public System {
 public:
  /// imu: of the whole recording, sorted; read if the options say so. It and workers must outlive the system.
  ElasticfusionSystem(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
                      const Workers& workers);

  /// The first frame with depth is the first one; the world is its camera. Error data_corrupt: the inertial
  /// samples do not cover the frames.
  [[nodiscard]] Result<health::FrameOutcome> process(const RgbdFrame& frame) override;
  /// The poses as loops have bent them, if there were any; the model is of these already.
  [[nodiscard]] Result<std::optional<Trajectory>> revise() override;
  /// The stable surfels, a triangle of each disc's area.
  [[nodiscard]] Surface take_surface() override;

 private:
  enum class Quality { good, bad };
  struct EarlierFrame {
    surfels::LiveFrame live;
    tracking::LiveLevel small;  ///< for the rotation where tracking starts
  };
  [[nodiscard]] Result<void> predict(std::int64_t capture_ns);
  Quality follow(const surfels::LiveFrame& live, const tracking::LivePyramid& levels,
                 health::FrameOutcome& outcome);
  [[nodiscard]] tracking::TrackedMotion track(const tracking::LivePyramid& levels,
                                              health::StageTimes& stages);
  [[nodiscard]] bool fits(const tracking::TrackedMotion& motion) const;
  void find_again(const surfels::LiveFrame& live, health::StageTimes& stages);
  void fuse(const surfels::LiveFrame& live, health::StageTimes& stages);
  void close_loops(const surfels::LiveFrame& live, health::StageTimes& stages);
  void render(health::StageTimes& stages);

  config::Config config_;
  SensorRig rig_;
  PinholeCamera camera_;
  const Workers& workers_;
  surfels::SurfelMap map_;
  surfels::SurfelFusion fusion_;
  surfels::ViewRenderer renderer_;
  surfels::SurfelView view_;  ///< the stable active surfels from where the camera was
  tracking::CameraTracker tracker_;
  deformation::LoopCloser loops_;
  std::optional<InertialTracking> inertial_;
  std::vector<deformation::TimedPose> poses_;  ///< of the frames that have one
  std::optional<EarlierFrame> before_;         ///< the frame before; nothing if it was elsewhere
  SE3 T_world_camera_;
  SE3 T_before_camera_;      ///< the last step
  std::int32_t frames_ = 0;  ///< since the first one
  int bad_frames_ = 0;       ///< in a row
};

}  // namespace fusebench::systems::elasticfusion
