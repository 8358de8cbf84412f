// Decides whether a frame is fused, and whether a lost frame may begin a map segment. The paper leaves both
// open.
#pragma once

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/health/frame_report.hpp"

namespace fusebench::acceptance {

/// Decides which frames are fused and give new patches. A frame is admitted if it has a pose, if its colour
/// and depth belong to one instant, and if it is not occluded. An occluding object is not part of the scene,
/// and patches cut from it would be wrong. An object that stays for health.max_occluded_frames is fused.
class FusionGate {
 public:
  /// Call it once for each frame. complete: neither colour nor depth repeats the image of the previous frame.
  [[nodiscard]] bool admits(const health::FrameReport& report, bool complete,
                            const config::HealthConfig& config);

 private:
  int occluded_frames_ = 0;  ///< in a row
};

/// True if a lost frame may be the first frame of a map segment (map_segments.hpp). lost_s: time since the
/// last frame that was not lost. complete: as in FusionGate::admits().
[[nodiscard]] bool may_begin_segment(const health::FrameReport& report, double lost_s, bool complete,
                                     const config::TermsConfig& terms, const config::SegmentsConfig& config);

}  // namespace fusebench::acceptance
