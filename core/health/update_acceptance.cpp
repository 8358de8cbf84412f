#include "core/health/update_acceptance.hpp"

#include <fmt/format.h>

#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/health_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/config/groups/terms_config.hpp"

namespace fusebench::health {

std::string rejection_reason(const FrameReport& report, const config::TermsConfig& terms,
                             const config::IekfConfig& iekf, const config::HealthConfig& health) {
  if (report.patches_accepted < iekf.min_patches) {
    return fmt::format("{}: {} of {} patches were usable (iekf.min_patches = {})", to_string(report.health),
                       report.patches_accepted, report.patches, iekf.min_patches);
  }
  if (report.certainty.rotation_sigma_rad > radians(health.max_rotation_sigma_deg) ||
      report.certainty.position_sigma_m > health.max_position_sigma_m) {
    return fmt::format(
        "uncertain: the pose against the model is known to {:.2f} degrees and {:.1f} cm "
        "(health.max_rotation_sigma_deg = {}, health.max_position_sigma_m = {})",
        degrees(report.certainty.rotation_sigma_rad), 100 * report.certainty.position_sigma_m,
        health.max_rotation_sigma_deg, health.max_position_sigma_m);
  }
  // Whatever the frame suffers from: a pose that most of the intensities contradict is none.
  if (2 * report.patches_contradicting > report.patches_tracked) {
    return fmt::format("inconsistent: the intensities of {} of {} tracked patches do not fit the pose",
                       report.patches_contradicting, report.patches_tracked);
  }
  if (terms.photometric_weight > 0 && report.correlation && *report.correlation < health.min_correlation) {
    return fmt::format(
        "the patches are not recognised: their correlation is {:.2f} (health.min_correlation = {})",
        *report.correlation, health.min_correlation);
  }
  return {};
}

void find_survivors(std::span<const patches::Patch> patches,
                    std::span<const measurement::PatchOutcome> outcomes, const config::PatchConfig& config,
                    std::vector<patches::TrackedCentre>& survivors) {
  survivors.clear();
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const measurement::PatchOutcome& outcome = outcomes[p];
    if (!outcome.accepted || outcome.mean_error_grey > config.max_mean_error) continue;
    survivors.push_back({outcome.centre_px, patches[p].age + 1});
    const bool same_shape = !outcome.shrunk && !outcome.extended;
    if (config.refresh == config::Refresh::keep && same_shape) survivors.back().kept = p;
  }
}

bool OcclusionGate::admits(const FrameReport& report, const config::HealthConfig& config) {
  occluded_frames_ = report.health == FrameHealth::occluded ? occluded_frames_ + 1 : 0;
  const bool clear = occluded_frames_ == 0 || occluded_frames_ > config.max_occluded_frames;
  return clear && report.status != FrameStatus::lost && !report.placed_by_depth;
}

}  // namespace fusebench::health
