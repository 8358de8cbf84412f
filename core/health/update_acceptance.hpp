// Whether the result of an update is believed, and whether its frame is fused. The paper leaves both open.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/config/groups/config_fwd.hpp"
#include "core/health/frame_report.hpp"

namespace fusebench::health {

/// Why an update, described in the report, is rejected; empty if it is accepted.
[[nodiscard]] std::string rejection_reason(const FrameReport& report, const config::TermsConfig& terms,
                                           const config::IekfConfig& iekf,
                                           const config::HealthConfig& health);

/// Where the patches that are good enough to be cut again are in the current frame: accepted, and with a mean
/// intensity error of at most patches.max_mean_error (Sec. 2.3). The memory of `survivors` is used again.
void find_survivors(std::span<const patches::Patch> patches,
                    std::span<const measurement::PatchOutcome> outcomes, const config::PatchConfig& config,
                    std::vector<patches::TrackedCentre>& survivors);

/// Keeps what has come to stand before many patches out of the model: it is no part of the scene, and patches
/// cut from it would lead astray. What stays there for health.max_occluded_frames is let in.
class OcclusionGate {
 public:
  /// Called once a frame; true if the frame may be fused.
  [[nodiscard]] bool admits(const FrameReport& report, const config::HealthConfig& config);

 private:
  int occluded_frames_ = 0;  ///< in a row
};

}  // namespace fusebench::health
