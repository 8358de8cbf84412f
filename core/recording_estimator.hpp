// The estimator for a whole recording: the pipeline of the paper (pipeline.hpp), the selection of the first
// frame, map segments while the camera is lost, and loop closure.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/replay.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/health/frame_report.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"
#include "core/estimator/places/loops/loop_closure.hpp"

namespace fusebench::core {

/// One run of the estimator over one recording.
class RecordingEstimator {
 public:
  /// imu: all samples of the recording, sorted by time (empty if terms.prior does not need them). imu and
  /// workers must outlive the estimator. replay: required for loops.mode = online and for revise(), which
  /// fuse the model again.
  RecordingEstimator(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
                     const Workers& workers, Replay replay = {});
  ~RecordingEstimator();

  /// Processes the next frame (time must increase). Frames before the first usable one are lost ("waiting for
  /// a usable first frame"). A lost frame is a report, not an error. Errors: IMU samples that do not cover
  /// the frame (data_corrupt), a full model (run_failed), errors of the replay. A loop may correct all
  /// earlier poses (FrameOutcome::poses_corrected; loops.mode = online).
  [[nodiscard]] Result<health::FrameReport> process(const RgbdFrame& frame);

  /// After the last frame: if loops change poses (loops.mode = final or online) or segments were joined,
  /// returns all poses in the map and fuses the model again at these poses; otherwise nothing. Errors: those
  /// of LoopClosure::close() and of the replay, a full model (run_failed).
  [[nodiscard]] Result<std::optional<Trajectory>> revise();
  /// Null if loops.mode = off.
  [[nodiscard]] const loops::LoopClosure* loops() const;

  /// Model of the map.
  [[nodiscard]] const tsdf::TsdfVolume& model() const;
  /// Moves the model out and destroys the estimator.
  [[nodiscard]] tsdf::TsdfVolume take_model() &&;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench::core
