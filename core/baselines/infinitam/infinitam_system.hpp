// InfiniTAM's method: track against a view of the model, fuse, render the next view (Kaehler et al., "Very
// High Frame Rate Volumetric Integration of Depth Images on Mobile Devices", 2015; Prisacariu et al.,
// "InfiniTAM v3", 2017). Model and ray casting are those of this project.
#pragma once

#include <cstdint>
#include <optional>

#include "core/baselines/infinitam/fern_relocaliser.hpp"
#include "core/baselines/infinitam/model_view.hpp"
#include "core/baselines/infinitam/pose_tracker.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/systems_config.hpp"
#include "core/system/system.hpp"

namespace fusebench::baselines::infinitam {

class InfinitamSystem final : public system::System {
 public:
  /// workers must outlive the system.
  InfinitamSystem(const config::InfinitamConfig& config, const config::DepthConfig& depth,
                  const config::TsdfConfig& tsdf, const SensorRig& rig, const Workers& workers);

  /// The world is the camera frame of the first frame with depth. Error run_failed: a full model.
  [[nodiscard]] Result<health::FrameOutcome> process(const RgbdFrame& frame) override;
  [[nodiscard]] system::Surface take_surface() override;

 private:
  enum class Quality { good, poor, failed };
  [[nodiscard]] Quality judge(const TrackedPose& pose) const;
  Quality track(const FrameLevels& levels, health::StageTimes& stages);
  Quality relocalise(const FrameLevels& levels, Quality quality, health::FrameOutcome& outcome);
  Result<void> fuse(const RgbdFrame& frame, health::StageTimes& stages);
  void render(health::StageTimes& stages);

  config::InfinitamConfig config_;
  config::DepthConfig depth_;
  PinholeCamera camera_;
  const Workers& workers_;
  tsdf::TsdfVolume model_;
  ModelRenderer renderer_;
  PoseTracker tracker_;
  FernRelocaliser relocaliser_;
  ModelView view_;
  std::optional<FrameLevels> before_;  ///< the previous frame
  SE3 T_world_camera_;
  std::uint32_t frames_ = 0;     ///< since the first one
  int unfused_good_frames_ = 0;  ///< frames that will not be fused, after a relocalisation
};

}  // namespace fusebench::baselines::infinitam
