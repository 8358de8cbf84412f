// Points that a frame provides for the alignment of later images: a few of each coarse pyramid level.
#pragma once

#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::alignment {

/// A pixel of a coarse pyramid level with its measured depth.
struct ReferencePoint {
  Vector3d point_camera = Vector3d::Zero();  ///< metres, in the reference camera
  double intensity = 0;                      ///< grey levels
};

/// The pixels with depth, for each level that is used for alignment.
class ReferencePoints {
 public:
  /// pyramid: of the frame, from level 0 to the coarsest level. depth_m: level 0, gated.
  void take(std::span<const GreyImage> pyramid, const DepthImage& depth_m, const PinholeCamera& camera,
            const config::AlignmentConfig& config);

  [[nodiscard]] std::span<const ReferencePoint> level(int level) const;
  [[nodiscard]] int coarsest_level() const { return finest_ + static_cast<int>(levels_.size()) - 1; }
  [[nodiscard]] int finest_level() const { return finest_; }
  [[nodiscard]] bool empty() const { return levels_.empty(); }

 private:
  int finest_ = 0;
  std::vector<std::vector<ReferencePoint>> levels_;  ///< finest level first
};

/// Number of pyramid levels of a frame: at least patch_levels, and as many as alignment needs. Alignment
/// needs none if it is switched off, and none below eight pixels in height.
[[nodiscard]] int pyramid_levels(const PinholeCamera& camera, int patch_levels,
                                 const config::AlignmentConfig& alignment);

}  // namespace fusebench::alignment
