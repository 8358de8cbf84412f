// Computes the start of the update of a frame. Patches converge from a distance of a few pixels. If the
// prediction may be farther off, whole images are aligned first: from the coarsest level that is needed, and
// from several starts.
#pragma once

#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/alignment/image_alignment.hpp"
#include "core/estimator/alignment/reference_points.hpp"
#include "core/estimator/filter/iekf.hpp"

namespace fusebench::alignment {

/// Result of the search.
struct FoundStart {
  filter::MeasuredVector start = filter::MeasuredVector::Zero();  ///< argument of iekf_update()
  double landing_sigma_px = 0;  ///< standard deviation of the predicted position of a pixel, level 0
  /// coarsest level that was aligned; -1: none was needed, the update starts at the prediction
  int coarsest_level = -1;
};

class StartSearch {
 public:
  /// The references must outlive it.
  StartSearch(const config::AlignmentConfig& alignment, int patch_levels,
              const config::PhotometricConfig& photometric, const config::IekfConfig& iekf,
              const SensorRig& rig);

  /// prior: its reference pose is that of the frame from which `reference` was taken. T_world_imu_last: pose
  /// if the camera stands still. pyramid: of the new frame. thorough: aligns all levels, whatever the
  /// uncertainty of the prior.
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

/// Standard deviation of the predicted pixel positions in the new frame (pixels of level 0): root mean square
/// over the points of the coarsest level, larger axis of each.
[[nodiscard]] double landing_sigma_px(const filter::GaussianState& prior, const ReferencePoints& reference,
                                      const SensorRig& rig);

}  // namespace fusebench::alignment
