// The pipeline of the paper for each frame: predict, deform and track patches, fuse, refresh patches.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/iekf.hpp"
#include "core/estimator/health/frame_report.hpp"
#include "core/estimator/patches/patches.hpp"
#include "core/steps/frame_preparation.hpp"
#include "core/steps/frame_update.hpp"
#include "core/steps/tracking_state.hpp"

namespace fusebench::core {

/// The steps of a frame. The state between frames is in Tracking; the other members are reused buffers.
class Pipeline {
 public:
  /// imu: all samples of the recording, sorted by time (empty if terms.prior does not need them). The
  /// references must outlive the pipeline. Starts with `tracking`.
  Pipeline(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
           const Workers& workers, std::unique_ptr<Tracking> tracking);

  /// Replaces the tracking and returns the previous one.
  std::unique_ptr<Tracking> exchange(std::unique_ptr<Tracking> tracking);
  [[nodiscard]] Tracking& tracking() { return *tracking_; }
  [[nodiscard]] const Tracking& tracking() const { return *tracking_; }

  /// Processes the next frame (time must increase). A lost frame is a report, not an error. Errors: IMU
  /// samples that do not cover the frame (data_corrupt), a full model (run_failed).
  [[nodiscard]] Result<health::FrameReport> process(const RgbdFrame& frame);

  /// Searches the last processed frame among the keyframes of the tracking, after exchange(), from this
  /// prior. Returns the report of a relocalised or a lost frame. `before`: report of process(). Errors: those
  /// of process().
  [[nodiscard]] Result<health::FrameReport> relocalise_again(const RgbdFrame& frame,
                                                             const filter::GaussianState& prior,
                                                             const health::FrameReport& before);
  /// New images of the last frame.
  [[nodiscard]] const Novelty& novelty() const { return novelty_; }
  [[nodiscard]] SE3 T_world_camera() const {
    return tracking_->estimate->mean.T_world_imu * rig_.T_imu_camera;
  }

  /// Repeats Sec. 2.3 at a revised state and for the estimated motion of the frame. Errors: a full model.
  [[nodiscard]] Result<void> fuse_again(const RgbdFrame& frame, const filter::FilterState& state);
  /// After the last fuse_again(): continues tracking from this estimate, with patches cut from the new model.
  void resume(const filter::GaussianState& estimate);

 private:
  [[nodiscard]] Result<health::FrameReport> finish_frame(health::FrameReport report, std::int64_t capture_ns);
  [[nodiscard]] Result<filter::GaussianState> predict(std::int64_t now_ns, health::StageTimes& stages) const;
  [[nodiscard]] filter::GaussianState dead_reckoned(const filter::GaussianState& predicted,
                                                    std::int64_t now_ns) const;
  /// True if the depth of the frame is new and covers at least health.min_depth_share of the image.
  [[nodiscard]] bool measures_depth() const;
  [[nodiscard]] health::FrameStatus locate(const filter::GaussianState& predicted,
                                           health::FrameReport& report);
  [[nodiscard]] bool track(const filter::GaussianState& prior, bool thorough, health::FrameReport& report);
  [[nodiscard]] filter::IekfResult update(const filter::GaussianState& prior, bool thorough,
                                          health::StageTimes& stages);
  [[nodiscard]] bool track_again(const filter::GaussianState& prior, bool thorough,
                                 health::FrameReport& report);
  [[nodiscard]] bool relocalise(const filter::GaussianState& prediction, health::FrameReport& report);
  [[nodiscard]] Result<void> fuse(health::FrameReport& report);
  [[nodiscard]] Result<void> integrate(const RgbdFrame& frame);
  void refresh(health::StageTimes& stages);
  void cut_patches();
  /// The frame for cutting patches.
  [[nodiscard]] patches::ReferenceFrame reference_frame() const {
    return {preparation_.pyramid(), preparation_.patch_depth_m(), rig_.camera, T_world_camera()};
  }
  /// Time since the previous frame.
  [[nodiscard]] double duration_s(std::int64_t now_ns) const {
    return seconds_between(tracking_->timestamp_ns, now_ns);
  }

  const config::Config& config_;
  const SensorRig& rig_;
  std::span<const ImuSample> imu_;
  const Workers& workers_;
  Novelty novelty_;               ///< of the current frame
  FramePreparation preparation_;  ///< of the current frame
  FrameUpdate deformed_update_;   ///< update with the patches deformed into the current frame
  patches::PatchWorkspace patch_workspace_;
  std::unique_ptr<Tracking> tracking_;  ///< never null
};

}  // namespace fusebench::core
