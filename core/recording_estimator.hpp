// The estimator over a whole recording: the steps of the paper (pipeline.hpp), and around them where the
// recording starts, what is tracked apart from the map while the camera is lost, and loops.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/replay.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/health/frame_report.hpp"
#include "core/loops/loop_closure.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::core {

/// One run of the estimator over one recording.
class RecordingEstimator {
 public:
  /// imu: all samples of the recording, sorted by time (empty if terms.prior does not need them); must
  /// outlive the estimator, as must workers. replay: needed for loops.mode = online and for revise(), where
  /// the model is fused again at other poses.
  RecordingEstimator(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
                     const Workers& workers, Replay replay = {});
  ~RecordingEstimator();

  /// Processes the next frame (time must increase). The first frame that can be used is the first one;
  /// those before are lost ("waiting for a usable first frame"). A lost frame is a report, not an error;
  /// errors are IMU samples that do not cover the frame (data_corrupt), a full model (run_failed), and those
  /// of the replay. A loop may correct all poses so far (FrameOutcome::poses_corrected; loops.mode = online).
  [[nodiscard]] Result<health::FrameReport> process(const RgbdFrame& frame);

  /// After the last frame: all poses in the map, if loops change them (loops.mode = final or online) or
  /// segments were joined to the map, and the model fused again at these; nothing if not. Errors: those of
  /// LoopClosure::close() and of the replay, a full model (run_failed).
  [[nodiscard]] Result<std::optional<Trajectory>> revise();
  /// Nothing if loops.mode = off.
  [[nodiscard]] const loops::LoopClosure* loops() const;

  /// Of the map.
  [[nodiscard]] const tsdf::TsdfVolume& model() const;
  /// The model, and the end of everything else that the estimator keeps.
  [[nodiscard]] tsdf::TsdfVolume take_model() &&;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench::core
