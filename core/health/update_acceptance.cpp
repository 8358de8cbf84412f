#include "core/health/update_acceptance.hpp"

#include <fmt/format.h>

namespace fusebench::health {

bool fails_chi2_gate(const FrameReport& report, const config::Config& config) {
  // Of well aligned patches it is about 1 at most: photometric.noise_grey is generous, and a lost frame makes
  // the learnt noise no less than that. Of those on wrong corners it is 3 to 4. How many patches agree says
  // less: until the noise is learnt, a sensor's depth alone may fail the gate.
  constexpr double kMostChi2 = 2.5;
  return config.terms.photometric_weight > 0 && report.chi2_photometric > kMostChi2;
}

std::string rejection_reason(const FrameReport& report, bool after_gap, const config::Config& config) {
  if (report.patches_accepted < config.iekf.min_patches) {
    return fmt::format("{}: {} of {} patches were usable (iekf.min_patches = {})", to_string(report.health),
                       report.patches_accepted, report.patches, config.iekf.min_patches);
  }
  // Without relocalisation there is nothing better to turn to.
  if (after_gap && config.terms.relocalisation && fails_chi2_gate(report, config)) {
    return fmt::format("after a gap the patches do not fit: {:.1f} times the variance of their noise",
                       report.chi2_photometric);
  }
  return {};
}

void find_survivors(std::span<const patches::Patch> patches,
                    std::span<const measurement::PatchOutcome> outcomes, const config::PatchConfig& config,
                    std::vector<patches::TrackedCentre>& survivors) {
  survivors.clear();
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const measurement::PatchOutcome& outcome = outcomes[p];
    if (outcome.accepted && outcome.mean_error_grey <= config.max_mean_error)
      survivors.push_back({outcome.centre_px, patches[p].age + 1});
  }
}

bool OcclusionGate::admits(const FrameReport& report) {
  constexpr int kMostOccludedFrames = 30;
  occluded_frames_ = report.health == FrameHealth::occluded ? occluded_frames_ + 1 : 0;
  const bool clear = occluded_frames_ == 0 || occluded_frames_ > kMostOccludedFrames;
  return clear && report.status != FrameStatus::lost;
}

}  // namespace fusebench::health
