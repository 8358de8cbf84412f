// The update of a frame: where it starts, and which of two basins it ends in. Around Eqs. 15-23, which are
// those of filter::iekf_update().
#pragma once

#include "core/alignment/start_search.hpp"
#include "core/base/parallel.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/iekf.hpp"
#include "core/frame_preparation.hpp"
#include "core/measurement/patch_measurement.hpp"
#include "core/repeated_images.hpp"
#include "core/tracking_state.hpp"

namespace fusebench::core {

class FrameUpdate {
 public:
  /// All references must outlive it.
  FrameUpdate(const config::Config& config, const SensorRig& rig, const Workers& workers);

  /// Updates the prior by the patches of the last frames in the prepared frame. Where the prediction is
  /// uncertain and the patches are hardly recognised, the update starts once more from the coarsest level,
  /// and the better of the two counts; thorough: it starts there at once.
  [[nodiscard]] filter::IekfResult run(const filter::GaussianState& prior, const Tracking& last,
                                       const FramePreparation& frame, const Novelty& novelty, bool thorough);

  /// From where another update of the same frame ended, which was prepared anew for the motion that it found.
  [[nodiscard]] filter::IekfResult run_from(const filter::MeasuredVector& start,
                                            const filter::GaussianState& prior, const Tracking& last,
                                            const FramePreparation& frame, const Novelty& novelty);

  /// After an update: each patch goes to where a translation of its own puts it, from the prediction on.
  void move_patches_alone(const filter::GaussianState& prior) {
    measurement_.move_patches_alone(prior.mean.T_world_imu);
  }

  /// Of the update that run() or run_from() returned last.
  [[nodiscard]] const measurement::PatchMeasurement& measurement() const { return measurement_; }

 private:
  const config::Config& config_;
  alignment::StartSearch search_;
  measurement::PatchMeasurement measurement_;
};

/// What the frame was prepared for, and the motion of the reference, around the prior.
[[nodiscard]] measurement::ReadoutMotion readout_motion(const filter::FilterState& prior,
                                                        const FramePreparation& frame);

/// How well the patches in view are recognised after an update: their mean correlation with the reference, of
/// which one that is not tracked counts as zero. Zero without any.
[[nodiscard]] double agreement(std::span<const measurement::PatchOutcome> outcomes);

}  // namespace fusebench::core
