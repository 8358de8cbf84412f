// Which patches are cut again after an update (Sec. 2.3).
#pragma once

#include <span>
#include <vector>

#include "core/config/groups/config_fwd.hpp"
#include "core/measurement/patch_measurement.hpp"
#include "core/patches/patches.hpp"

namespace fusebench::acceptance {

/// Where the patches that are good enough to be cut again are in the current frame: accepted, and with a mean
/// intensity error of at most patches.max_mean_error (Sec. 2.3). The memory of `survivors` is used again.
void find_survivors(std::span<const patches::Patch> patches,
                    std::span<const measurement::PatchOutcome> outcomes, const config::PatchConfig& config,
                    std::vector<patches::TrackedCentre>& survivors);

/// Whether the patches of the reference frame are to be cut anew from the current frame: in each frame, or
/// when the image no longer agrees with them (patches.refresh). outcomes: of these patches, or none.
[[nodiscard]] bool needs_new_anchor(std::span<const measurement::PatchOutcome> outcomes,
                                    const config::PatchConfig& config);

}  // namespace fusebench::acceptance
