// Deferred fusion: old surfaces that are seen again and do not fit the measured depth are not fused over,
// which would create double walls. A loop that is accepted soon corrects the poses, and the model is then
// fused again.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/raycast/surface_point.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::loops {

class PendingRevisits {
 public:
  /// Both must outlive it.
  PendingRevisits(const config::DepthConfig& depth, const config::LoopsConfig& loops,
                  const PinholeCamera& camera)
      : depth_(depth), loops_(loops), camera_(camera) {}

  /// Returns the part of the depth (metres) that may be fused at this pose; nothing if all of it may be.
  /// Excluded is depth in front of, on or behind surfaces that were not fused for loops.least_age_s, if their
  /// median misfit exceeds 1 cm and two standard deviations of the depth noise. After loops.max_pending_s of
  /// misfits all depth is fused. If that option is 0, the check is skipped.
  [[nodiscard]] std::optional<DepthImage> depth_to_fuse(const tsdf::TsdfVolume& model, const RgbdFrame& frame,
                                                        const SE3& T_world_camera, const Workers& workers);

 private:
  void look(const tsdf::TsdfVolume& model, const RgbdFrame& frame, const SE3& T_world_camera,
            const Workers& workers);
  [[nodiscard]] bool do_not_fit() const;

  const config::DepthConfig& depth_;
  const config::LoopsConfig& loops_;
  const PinholeCamera& camera_;
  std::optional<std::int64_t> pending_since_ns_;  ///< stamp of the first of consecutive misfitting frames
  std::vector<raycast::SurfacePoint> surfaces_;   ///< of the model, one pixel for each cell of the image
  std::vector<bool> old_;                         ///< cells that show an old surface
  std::vector<double> misfits_;                   ///< of old cells: distance divided by the tolerance
};

}  // namespace fusebench::loops
