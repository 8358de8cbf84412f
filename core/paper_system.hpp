// The paper's filter and its ablations as one of the systems.
#pragma once

#include <span>

#include "core/config/groups/config_fwd.hpp"
#include "core/pipeline.hpp"
#include "core/systems/system.hpp"

namespace fusebench::core {

class PaperSystem final : public systems::System {
 public:
  /// As Pipeline.
  PaperSystem(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
              const Workers& workers)
      : pipeline_(config, rig, imu, workers) {}

  [[nodiscard]] Result<health::FrameOutcome> process(const RgbdFrame& frame) override;
  [[nodiscard]] const health::FrameReport* filter_report() const override { return &report_; }
  [[nodiscard]] bool wants_frames_again() const override { return pipeline_.wants_frames_again(); }
  void resume() override { pipeline_.resume(); }
  [[nodiscard]] Result<std::optional<Trajectory>> revise() override { return pipeline_.revise(); }
  [[nodiscard]] Result<void> fuse_again(const RgbdFrame& frame) override {
    return pipeline_.fuse_again(frame);
  }
  [[nodiscard]] const loops::LoopClosure* loops() const override { return pipeline_.loops(); }
  [[nodiscard]] systems::Surface take_surface() override { return std::move(pipeline_).take_model(); }

 private:
  Pipeline pipeline_;
  health::FrameReport report_;  ///< of the last frame
};

}  // namespace fusebench::core
