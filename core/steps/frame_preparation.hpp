// Prepares a frame for its update: compensates it to one instant for all rows, builds the image pyramid,
// applies the depth gates. Not in the paper.
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/pose_clones.hpp"
#include "core/estimator/health/stage_times.hpp"
#include "core/estimator/measurement/patch_measurement.hpp"
#include "core/estimator/preprocessing/camera_motion.hpp"
#include "core/steps/repeated_images.hpp"

namespace fusebench::core {

/// The prepared current frame. Its buffers are reused for each frame.
class FramePreparation {
 public:
  /// The references must outlive it.
  FramePreparation(const config::TermsConfig& terms, const config::PatchConfig& patches,
                   const config::DepthConfig& depth, const config::AlignmentConfig& alignment,
                   const SensorRig& rig, const Workers& workers)
      : terms_(terms),
        patches_(patches),
        depth_(depth),
        alignment_(alignment),
        rig_(rig),
        workers_(workers) {}

  /// Compensates grey and depth for the motion, if rows or depth have other instants than the frame and the
  /// variant compensates, then applies the depth gates. Colour is compensated by prepare_color(). The frame
  /// must outlive the preparation.
  void prepare(const RgbdFrame& frame, const filter::FilterState& motion, health::StageTimes& stages);

  /// Prepares the same frame again if `motion` differs from the compensated motion by more than the
  /// tolerance. True if it was prepared again.
  bool prepare_again(const filter::FilterState& motion, const preprocessing::VelocityTolerance& tolerance,
                     health::StageTimes& stages);

  /// Compensates the colour of the last prepared frame. Only frames that are fused need it.
  void prepare_color(health::StageTimes& stages);

  /// Motion for which the frame was compensated; null if it was not.
  [[nodiscard]] const filter::FilterState* compensated_motion() const {
    return compensated_ ? &motion_ : nullptr;
  }
  /// Compensation of the frame, relative to its estimated motion.
  [[nodiscard]] filter::CompensatedReadout compensated_readout(const filter::FilterState& motion) const {
    const filter::FilterState& compensated = compensated_ ? motion_ : motion;
    const Vector6d rate = filter::pose_rate(compensated);
    return {filter::pose_rate(motion) - rate, rate, compensated.sensors.timing_s()};
  }
  [[nodiscard]] const preprocessing::FrameTiming& timing() const { return timing_; }

  [[nodiscard]] const RgbdFrame& frame() const { return frame_; }
  /// The pyramid levels of the patches.
  [[nodiscard]] std::span<const GreyImage> pyramid() const;
  /// All pyramid levels, with the coarser ones for the alignment of whole images.
  [[nodiscard]] std::span<const GreyImage> whole_pyramid() const { return pyramid_; }
  /// Depth for cutting patches, gated if the configuration requires it.
  [[nodiscard]] const DepthImage& patch_depth_m() const;
  [[nodiscard]] measurement::ObservedFrame observed(const Novelty& novelty) const {
    return {pyramid(), frame_.depth_m, novelty.color, novelty.depth};
  }

 private:
  const config::TermsConfig& terms_;
  const config::PatchConfig& patches_;
  const config::DepthConfig& depth_;
  const config::AlignmentConfig& alignment_;
  const SensorRig& rig_;
  const Workers& workers_;
  std::vector<GreyImage> pyramid_;
  RgbdFrame frame_;  ///< a compensated frame has the colour of an earlier frame until prepare_color()
  DepthImage ungated_depth_m_;         ///< before the depth gates
  const RgbdFrame* source_ = nullptr;  ///< the frame as read
  bool compensated_ = false;
  preprocessing::FrameTiming timing_;  ///< timing_, motion_ and compensated_ describe the compensation
  filter::FilterState motion_;
  preprocessing::CameraVelocity velocity_;
};

}  // namespace fusebench::core
