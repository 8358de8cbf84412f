// What a frame leaves for the alignment of later images with it: a few points of each coarse pyramid level.
#pragma once

#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::alignment {

/// A pixel of a coarse pyramid level.
struct ReferencePoint {
  Vector3d point_camera = Vector3d::Zero();  ///< metres, by measured depth, in the reference camera
  double intensity = 0;                      ///< grey levels
};

/// The pixels with depth of each level that is aligned by.
class ReferencePoints {
 public:
  /// pyramid: of the frame, level 0 first, up to the coarsest level; depth of level 0, gated.
  void take(std::span<const GreyImage> pyramid, const DepthImage& depth_m, const PinholeCamera& camera,
            const config::AlignmentConfig& config);

  [[nodiscard]] std::span<const ReferencePoint> level(int level) const;
  [[nodiscard]] int coarsest_level() const { return finest_ + static_cast<int>(levels_.size()) - 1; }
  [[nodiscard]] int finest_level() const { return finest_; }
  [[nodiscard]] bool empty() const { return levels_.empty(); }

 private:
  int finest_ = 0;
  std::vector<std::vector<ReferencePoint>> levels_;  ///< from the finest on
};

/// Number of pyramid levels of a frame: those of the patches, and those that alignment needs (none where it
/// is switched off; levels below eight pixels in height are of no use).
[[nodiscard]] int pyramid_levels(const PinholeCamera& camera, int patch_levels,
                                 const config::AlignmentConfig& alignment);

}  // namespace fusebench::alignment
