// What is derived from a frame before it is used: one instant for all rows, an image pyramid, depth gates.
// Not in the paper.
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/pose_clones.hpp"
#include "core/health/stage_times.hpp"
#include "core/measurement/patch_measurement.hpp"
#include "core/preprocessing/camera_motion.hpp"
#include "core/repeated_images.hpp"

namespace fusebench::core {

/// The current frame, prepared. Its memory serves one frame after the other.
class FramePreparation {
 public:
  /// All references must outlive it.
  FramePreparation(const config::TermsConfig& terms, const config::PatchConfig& patches,
                   const config::DepthConfig& depth, const config::AlignmentConfig& alignment,
                   const SensorRig& rig, const Workers& workers)
      : terms_(terms),
        patches_(patches),
        depth_(depth),
        alignment_(alignment),
        rig_(rig),
        workers_(workers) {}

  /// Grey and depth, compensated for the motion (if rows or depth are of other instants than the frame, as
  /// far as the state knows, and the variant undoes that) and gated. Colour has to wait for prepare_color().
  /// The frame must outlive what is prepared from it.
  void prepare(const RgbdFrame& frame, const filter::FilterState& motion, health::StageTimes& stages);

  /// The same frame for another motion, if that differs from the one that it was prepared for by more than
  /// the tolerance. True if it was prepared again.
  bool prepare_again(const filter::FilterState& motion, const preprocessing::VelocityTolerance& tolerance,
                     health::StageTimes& stages);

  /// Colour of the frame that was prepared last, if it was compensated. Apart, since only frames that are
  /// fused need it.
  void prepare_color(health::StageTimes& stages);

  /// The motion that the read-out was undone for; nothing if none was.
  [[nodiscard]] const filter::FilterState* undone_motion() const { return compensated_ ? &motion_ : nullptr; }
  /// What was undone, against the motion that the frame turned out to have.
  [[nodiscard]] filter::UndoneReadout undone_readout(const filter::FilterState& motion) const {
    const filter::FilterState& undone = compensated_ ? motion_ : motion;
    const Vector6d rate = filter::pose_rate(undone);
    return {filter::pose_rate(motion) - rate, rate, undone.sensors.timing_s()};
  }
  [[nodiscard]] const preprocessing::FrameTiming& timing() const { return timing_; }

  [[nodiscard]] const RgbdFrame& frame() const { return frame_; }
  /// The levels that patches have.
  [[nodiscard]] std::span<const GreyImage> pyramid() const;
  /// And the coarser ones that whole images are aligned by.
  [[nodiscard]] std::span<const GreyImage> whole_pyramid() const { return pyramid_; }
  /// Depth that patches are cut by: gated or, if the configuration says so, not.
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
  RgbdFrame frame_;             ///< compensated ones have the colour of an earlier one until prepare_color()
  DepthImage ungated_depth_m_;  ///< before the gates
  const RgbdFrame* source_ = nullptr;  ///< as it was read
  bool compensated_ = false;
  preprocessing::FrameTiming timing_;  ///< these three: that it was compensated for, if at all
  filter::FilterState motion_;
  preprocessing::CameraVelocity velocity_;
};

}  // namespace fusebench::core
