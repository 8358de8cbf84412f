// What is derived from a frame before it is used: one instant for all rows, an image pyramid, depth gates.
// Not in the paper.
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/config.hpp"
#include "core/health/stage_times.hpp"
#include "core/measurement/patch_measurement.hpp"
#include "core/preprocessing/camera_motion.hpp"
#include "core/repeated_images.hpp"

namespace fusebench::core {

/// The current frame, prepared. Its memory serves one frame after the other.
class FramePreparation {
 public:
  /// All references must outlive it.
  FramePreparation(const config::Config& config, const SensorRig& rig, const Workers& workers)
      : config_(config), rig_(rig), workers_(workers) {}

  /// True if the frame that was prepared for the predicted motion has to be prepared again for the estimated
  /// one before it is fused.
  [[nodiscard]] bool is_outdated(const filter::FilterState& predicted,
                                 const filter::FilterState& estimated) const;

  /// Grey and depth, compensated for the motion (if rows or depth are of other instants than the frame, as
  /// far as the state knows, and the variant undoes that) and gated. Colour has to wait for prepare_color().
  void prepare(const RgbdFrame& frame, const filter::FilterState& motion, health::StageTimes& stages);

  /// Colour of the frame that was prepared last, if it was compensated. Apart, since only frames that are
  /// fused need it.
  void prepare_color(const RgbdFrame& frame, health::StageTimes& stages);

  [[nodiscard]] const RgbdFrame& frame() const { return frame_; }
  /// The levels that patches have.
  [[nodiscard]] std::span<const GreyImage> pyramid() const {
    return std::span(pyramid_).first(static_cast<std::size_t>(config_.patches.levels));
  }
  /// And the coarser ones that whole images are aligned by.
  [[nodiscard]] std::span<const GreyImage> whole_pyramid() const { return pyramid_; }
  [[nodiscard]] measurement::ObservedFrame observed(const Novelty& novelty) const {
    return {pyramid(), frame_.depth_m, novelty.color, novelty.depth};
  }

 private:
  const config::Config& config_;
  const SensorRig& rig_;
  const Workers& workers_;
  std::vector<GreyImage> pyramid_;
  RgbdFrame frame_;             ///< compensated ones have the colour of an earlier one until prepare_color()
  DepthImage ungated_depth_m_;  ///< before the gates
  bool compensated_ = false;
  preprocessing::FrameTiming timing_;  ///< these two: that it was compensated for, if at all
  preprocessing::CameraVelocity velocity_;
};

}  // namespace fusebench::core
