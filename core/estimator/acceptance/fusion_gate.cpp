#include "core/estimator/acceptance/fusion_gate.hpp"

#include "core/config/groups/health_config.hpp"
#include "core/config/groups/relocalisation_config.hpp"
#include "core/config/groups/terms_config.hpp"

namespace fusebench::acceptance {

bool FusionGate::admits(const health::FrameReport& report, bool complete,
                        const config::HealthConfig& config) {
  occluded_frames_ = report.health == health::FrameHealth::occluded ? occluded_frames_ + 1 : 0;
  const bool clear = occluded_frames_ == 0 || occluded_frames_ > config.max_occluded_frames;
  return clear && complete && report.status != health::FrameStatus::lost && !report.placed_by_depth;
}

bool may_begin_segment(const health::FrameReport& report, double lost_s, bool complete,
                       const config::TermsConfig& terms, const config::SegmentsConfig& config) {
  return terms.relocalisation && config.begin_after_s > 0 && report.status == health::FrameStatus::lost &&
         health::is_sound(report.health) && complete && lost_s >= config.begin_after_s;
}

}  // namespace fusebench::acceptance
