// Surfaces that are seen again after a long time and do not fit what is measured now. Fused over, they would
// become double walls; a loop that is accepted soon explains them, and the model is then fused again.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/raycast/surface_point.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::loops {

class PendingRevisits {
 public:
  /// Both must outlive it.
  PendingRevisits(const config::DepthConfig& depth, const config::LoopsConfig& loops,
                  const PinholeCamera& camera)
      : depth_(depth), loops_(loops), camera_(camera) {}

  /// What of the frame's depth (metres) may be fused at this pose: all of it but what is seen before, on or
  /// behind surfaces that nothing was fused into for loops.least_age_s, if these do not fit (by median, more
  /// than 1 cm and two standard deviations of the depth noise apart). Nothing if all of it may be, as after
  /// loops.max_pending_s of frames that did not fit; where that is 0, neither model nor frame is looked at.
  [[nodiscard]] std::optional<DepthImage> depth_to_fuse(const tsdf::TsdfVolume& model, const RgbdFrame& frame,
                                                        const SE3& T_world_camera, const Workers& workers);

 private:
  void look(const tsdf::TsdfVolume& model, const RgbdFrame& frame, const SE3& T_world_camera,
            const Workers& workers);
  [[nodiscard]] bool do_not_fit() const;

  const config::DepthConfig& depth_;
  const config::LoopsConfig& loops_;
  const PinholeCamera& camera_;
  std::optional<std::int64_t> pending_since_ns_;  ///< stamp of the first frame in a row that did not fit
  std::vector<raycast::SurfacePoint> surfaces_;   ///< of the model, a pixel of each cell of the image
  std::vector<bool> old_;                         ///< cells that see such a surface
  std::vector<double> misfits_;                   ///< of these: distance by the allowed one
};

}  // namespace fusebench::loops
