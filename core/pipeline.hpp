// The system of the paper, frame by frame: predict, deform and track patches, fuse, refresh patches.
#pragma once

#include <memory>
#include <span>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/frame_report.hpp"
#include "core/parallel.hpp"
#include "core/tsdf_volume.hpp"
#include "core/types.hpp"

namespace fusebench {

/// One run of the estimator over one recording.
class Pipeline {
 public:
  /// imu: all samples of the recording, sorted by time (empty if terms.prior does not need them); must
  /// outlive the pipeline, as must workers.
  Pipeline(const Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
           const Workers& workers);
  ~Pipeline();

  /// Processes the next frame (time must increase). The first frame that can be used is the first one;
  /// those before are lost ("waiting for a usable first frame"). A lost frame is a report, not an error;
  /// errors are IMU samples that do not cover the frame (data_corrupt) and a full model (run_failed).
  [[nodiscard]] Result<FrameReport> process(const RgbdFrame& frame);

  [[nodiscard]] const TsdfVolume& model() const;
  /// The model, and the end of everything else that the pipeline keeps.
  [[nodiscard]] TsdfVolume take_model() &&;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench
