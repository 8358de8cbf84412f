// Where the update of a frame starts. Patches converge from a few pixels; where the prediction may be farther
// off, whole images are aligned first, from the coarsest level that is needed, and from more than one start.
#pragma once

#include <span>
#include <vector>

#include "core/alignment/image_alignment.hpp"
#include "core/alignment/reference_points.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/iekf.hpp"

namespace fusebench::alignment {

/// What a search found.
struct FoundStart {
  filter::MeasuredVector start = filter::MeasuredVector::Zero();  ///< as iekf_update() takes it
  double landing_sigma_px = 0;  ///< standard deviation of where the prediction places a pixel, level 0
  int coarsest_level = -1;  ///< of the alignment; -1: none was needed, the update starts at the prediction
};

class StartSearch {
 public:
  /// The references must outlive it.
  StartSearch(const config::AlignmentConfig& alignment, int patch_levels,
              const config::PhotometricConfig& photometric, const config::IekfConfig& iekf,
              const SensorRig& rig);

  /// prior: its reference pose is that of the frame that `reference` was taken from. T_world_imu_last: where
  /// the camera is if it stands still. pyramid: of the new frame. `thorough`: on all levels, whatever the
  /// prior says.
  [[nodiscard]] FoundStart find(const filter::GaussianState& prior, const SE3& T_world_imu_last,
                                const ReferencePoints& reference, std::span<const GreyImage> pyramid,
                                bool thorough);

 private:
  [[nodiscard]] std::vector<filter::MeasuredVector> starts(const filter::GaussianState& prior,
                                                           const SE3& T_world_imu_last, double sigma_px,
                                                           const ReferencePoints& reference) const;
  [[nodiscard]] int coarsest_level(double sigma_px, const ReferencePoints& reference) const;

  const config::AlignmentConfig& config_;
  int patch_levels_;
  const config::IekfConfig& iekf_;
  const SensorRig& rig_;
  ImageAlignment alignment_;
};

/// Standard deviation, root mean square over the points of the coarsest level, of where the prediction places
/// them in the new frame: pixels of level 0, the larger axis of each.
[[nodiscard]] double landing_sigma_px(const filter::GaussianState& prior, const ReferencePoints& reference,
                                      const SensorRig& rig);

}  // namespace fusebench::alignment
