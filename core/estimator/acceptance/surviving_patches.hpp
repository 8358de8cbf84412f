// Selects the patches that are cut again after an update (Sec. 2.3).
#pragma once

#include <span>
#include <vector>

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/measurement/patch_measurement.hpp"
#include "core/estimator/patches/patches.hpp"

namespace fusebench::acceptance {

/// Writes the centres, in the current frame, of the patches that are cut again: accepted, with a mean
/// intensity error of at most patches.max_mean_error (Sec. 2.3). Reuses the memory of `survivors`.
void find_survivors(std::span<const patches::Patch> patches,
                    std::span<const measurement::PatchOutcome> outcomes, const config::PatchConfig& config,
                    std::vector<patches::TrackedCentre>& survivors);

/// True if the reference patches must be cut from the current frame: in each frame, or when the image does
/// not fit them (patches.refresh). outcomes: those of these patches; may be empty.
[[nodiscard]] bool needs_new_anchor(std::span<const measurement::PatchOutcome> outcomes,
                                    const config::PatchConfig& config);

}  // namespace fusebench::acceptance
