// The update of a frame: selects its start and the better of two basins of convergence. Calls
// filter::iekf_update() (Eqs. 15-23).
#pragma once

#include "core/base/parallel.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/alignment/start_search.hpp"
#include "core/estimator/filter/iekf.hpp"
#include "core/estimator/measurement/patch_measurement.hpp"
#include "core/steps/frame_preparation.hpp"
#include "core/steps/repeated_images.hpp"
#include "core/steps/tracking_state.hpp"

namespace fusebench::core {

class FrameUpdate {
 public:
  /// The references must outlive it.
  FrameUpdate(const config::Config& config, const SensorRig& rig, const Workers& workers);

  /// Updates the prior with the patches of the anchor, observed in the prepared frame. If the prediction
  /// is uncertain and the patches correlate badly, a second update starts from the coarsest level, and the
  /// better result is returned. thorough: starts from the coarsest level at once.
  [[nodiscard]] filter::IekfResult run(const filter::GaussianState& prior, const Tracking& last,
                                       const FramePreparation& frame, const Novelty& novelty, bool thorough);

  /// Updates again from the result of another update of the same frame, after the frame was prepared for the
  /// estimated motion.
  [[nodiscard]] filter::IekfResult run_from(const filter::MeasuredVector& start,
                                            const filter::GaussianState& prior, const Tracking& last,
                                            const FramePreparation& frame, const Novelty& novelty);

  /// Moves each patch by its own translation, from its predicted position. Call it after an update.
  void move_patches_alone(const filter::GaussianState& prior) {
    measurement_.move_patches_alone(prior.mean.T_world_imu);
  }

  /// Measurement of the last run() or run_from().
  [[nodiscard]] const measurement::PatchMeasurement& measurement() const { return measurement_; }

 private:
  const config::Config& config_;
  alignment::StartSearch search_;
  measurement::PatchMeasurement measurement_;
};

/// Compensated motion of the frame and motion of the reference, relative to the prior.
[[nodiscard]] measurement::ReadoutMotion readout_motion(const filter::FilterState& prior,
                                                        const FramePreparation& frame);

/// Mean correlation of the patches in view with the reference after an update; an untracked patch counts as
/// zero. Zero without patches.
[[nodiscard]] double agreement(std::span<const measurement::PatchOutcome> outcomes);

}  // namespace fusebench::core
