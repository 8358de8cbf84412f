// Our own pipeline in the contest: its costs, split as the peers' work is.
#pragma once

#include <optional>

#include "core/base/parallel.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"
#include "core/recording_estimator.hpp"
#include "datasets/recording/recording.hpp"
#include "tests/bench/peers/contestant.hpp"

namespace fusebench::peers {

/// CPU time of one frame, milliseconds.
struct OurCost {
  double tracking_ms = 0;  ///< preprocess, predict, update, refresh
  double fusion_ms = 0;    ///< fuse
  double frame_ms = 0;     ///< all of process(), also what no stage counts
};

class OurPipeline {
 public:
  /// The recording must outlive it.
  OurPipeline(const Config& config, const Recording& recording)
      : rig_(recording.rig), pipeline_(config, recording.rig, recording.imu, workers_) {}

  /// Errors: those of RecordingEstimator::process().
  [[nodiscard]] Result<OurCost> process(const RgbdFrame& frame);

  /// T_before_now by the last two frames' poses; nothing if the last frame was lost.
  [[nodiscard]] const std::optional<SE3>& motion() const { return motion_; }
  [[nodiscard]] const SE3& T_world_camera() const { return T_world_camera_; }
  /// How the camera moved at the last frame.
  [[nodiscard]] const CameraVelocity& velocity() const { return velocity_; }
  /// Whether the last frame went into the model.
  [[nodiscard]] bool fused() const { return fused_; }
  [[nodiscard]] const TsdfVolume& model() const { return pipeline_.model(); }
  [[nodiscard]] FusedSurface surface() const;

 private:
  SensorRig rig_;
  Workers workers_{1};
  RecordingEstimator pipeline_;
  SE3 T_world_camera_;
  CameraVelocity velocity_;
  std::optional<SE3> motion_;
  bool fused_ = false;
};

}  // namespace fusebench::peers
