// The estimator over a whole recording: the steps of the paper (pipeline.hpp), and around them where the
// recording starts, what is tracked apart from the map while the camera is lost, and loops.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
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
  /// outlive the estimator, as must workers.
  RecordingEstimator(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
                     const Workers& workers);
  ~RecordingEstimator();

  /// Processes the next frame (time must increase). The first frame that can be used is the first one;
  /// those before are lost ("waiting for a usable first frame"). A lost frame is a report, not an error;
  /// errors are IMU samples that do not cover the frame (data_corrupt) and a full model (run_failed).
  [[nodiscard]] Result<health::FrameReport> process(const RgbdFrame& frame);

  /// After process(): true if a loop has corrected all poses so far (loops.mode = online). Then the model is
  /// empty, and is fused again from all frames so far, in order, by fuse_again(), before resume().
  [[nodiscard]] bool wants_frames_again() const;
  /// Error run_failed: a full model.
  [[nodiscard]] Result<void> fuse_again(const RgbdFrame& frame);
  void resume();

  /// After the last frame: all poses in the map, if loops change them (loops.mode = final or online) or
  /// segments were joined to the map; nothing if not. Then the model is empty, and is fused again from all
  /// frames, in order. Errors: those of LoopClosure::close().
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
