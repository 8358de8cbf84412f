// Whether a frame is fused, and whether one that is lost begins a map segment. The paper leaves both open.
#pragma once

#include "core/config/groups/config_fwd.hpp"
#include "core/health/frame_report.hpp"

namespace fusebench::acceptance {

/// Decides which frames are fused, and patches cut from: those with a pose and with colour and depth of one
/// instant, unless something new covers many patches. It is no part of the scene, and patches cut from it
/// would lead astray; what stays there for health.max_occluded_frames is fused.
class FusionGate {
 public:
  /// Called once a frame. complete: neither colour nor depth are those of the frame before.
  [[nodiscard]] bool admits(const health::FrameReport& report, bool complete,
                            const config::HealthConfig& config);

 private:
  int occluded_frames_ = 0;  ///< in a row
};

/// True if a lost frame may be the first one of a map segment (map_segments.hpp). lost_s: since the last
/// frame that was not lost; complete: as above.
[[nodiscard]] bool may_begin_segment(const health::FrameReport& report, double lost_s, bool complete,
                                     const config::TermsConfig& terms, const config::SegmentsConfig& config);

}  // namespace fusebench::acceptance
