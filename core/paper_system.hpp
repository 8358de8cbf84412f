// The paper's filter and its ablations as a system.
#pragma once

#include <span>
#include <utility>

#include "core/base/replay.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/recording_estimator.hpp"
#include "core/system/system.hpp"

namespace fusebench::core {

class PaperSystem final : public system::System {
 public:
  /// Parameters as RecordingEstimator.
  PaperSystem(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
              const Workers& workers, Replay replay)
      : estimator_(config, rig, imu, workers, std::move(replay)) {}

  [[nodiscard]] Result<health::FrameOutcome> process(const RgbdFrame& frame) override;
  [[nodiscard]] const health::FrameReport* filter_report() const override { return &report_; }
  [[nodiscard]] Result<std::optional<Trajectory>> revise() override { return estimator_.revise(); }
  [[nodiscard]] const loops::LoopClosure* loops() const override { return estimator_.loops(); }
  [[nodiscard]] system::Surface take_surface() override { return std::move(estimator_).take_model(); }

 private:
  RecordingEstimator estimator_;
  health::FrameReport report_;  ///< of the last frame
};

}  // namespace fusebench::core
