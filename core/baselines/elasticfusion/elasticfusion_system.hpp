// ElasticFusion's method on the CPU (Whelan et al., "ElasticFusion: Dense SLAM Without A Pose Graph", RSS
// 2015, and "ElasticFusion: Real-time dense SLAM and light source estimation", IJRR 2016): a map of surfels,
// tracking by colour and depth, and deformation of the map by loops.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/baselines/elasticfusion/deformation/loop_closer.hpp"
#include "core/baselines/elasticfusion/inertial_tracking.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_fusion.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_view.hpp"
#include "core/baselines/elasticfusion/tracking/camera_tracker.hpp"
#include "core/config/config.hpp"
#include "core/system/system.hpp"

namespace fusebench::baselines::elasticfusion {

class ElasticfusionSystem final : public system::System {
 public:
  /// imu: of the whole recording, sorted; used if the options require it. imu and workers must outlive the
  /// system.
  ElasticfusionSystem(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
                      const Workers& workers);

  /// The world is the camera frame of the first frame with depth. Error data_corrupt: the inertial samples do
  /// not cover the frames.
  [[nodiscard]] Result<health::FrameOutcome> process(const RgbdFrame& frame) override;
  /// Poses after the deformations by loops, if there were any; the model is already deformed.
  [[nodiscard]] Result<std::optional<Trajectory>> revise() override;
  /// The stable surfels, as triangles with the area of their discs.
  [[nodiscard]] system::Surface take_surface() override;

 private:
  enum class Quality { good, bad };
  struct EarlierFrame {
    surfels::LiveFrame live;
    tracking::LiveLevel small;  ///< start of tracking: rotation at a coarse level
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
  surfels::SurfelView view_;  ///< stable active surfels at the last pose
  tracking::CameraTracker tracker_;
  deformation::LoopCloser loops_;
  std::optional<InertialTracking> inertial_;
  std::vector<deformation::TimedPose> poses_;  ///< of the frames with a pose
  std::optional<EarlierFrame> before_;         ///< previous frame; nothing after a relocalisation
  SE3 T_world_camera_;
  SE3 T_before_camera_;      ///< the last step
  std::int32_t frames_ = 0;  ///< since the first one
  int bad_frames_ = 0;       ///< in a row
};

}  // namespace fusebench::baselines::elasticfusion
