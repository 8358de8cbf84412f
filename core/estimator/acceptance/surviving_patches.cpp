#include "core/estimator/acceptance/surviving_patches.hpp"

#include <algorithm>

#include "core/config/groups/patches_config.hpp"

namespace fusebench::acceptance {

namespace {

bool survives(const measurement::PatchOutcome& outcome, const config::PatchConfig& config) {
  return outcome.accepted && outcome.mean_error_grey <= config.max_mean_error;
}

}  // namespace

void find_survivors(std::span<const patches::Patch> patches,
                    std::span<const measurement::PatchOutcome> outcomes, const config::PatchConfig& config,
                    std::vector<patches::TrackedCentre>& survivors) {
  survivors.clear();
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const measurement::PatchOutcome& outcome = outcomes[p];
    if (!survives(outcome, config)) continue;
    survivors.push_back({outcome.centre_px, patches[p].age + 1});
  }
}

bool needs_new_anchor(std::span<const measurement::PatchOutcome> outcomes,
                      const config::PatchConfig& config) {
  double agreement = 0;
  for (const measurement::PatchOutcome& outcome : outcomes) {
    if (survives(outcome, config)) agreement += std::max(0.0, outcome.correlation);
  }
  return agreement <= config.anchor_share * static_cast<double>(outcomes.size());
}

}  // namespace fusebench::acceptance
