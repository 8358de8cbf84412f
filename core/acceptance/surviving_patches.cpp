#include "core/acceptance/surviving_patches.hpp"

#include "core/config/groups/patches_config.hpp"

namespace fusebench::acceptance {

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

}  // namespace fusebench::acceptance
