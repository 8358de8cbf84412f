// What the estimator carries from frame to frame.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/config.hpp"
#include "core/filter_state.hpp"
#include "core/patches.hpp"
#include "core/relocalisation.hpp"
#include "core/residual_scale.hpp"
#include "core/tsdf_volume.hpp"
#include "core/types.hpp"
#include "core/update_acceptance.hpp"

namespace fusebench {

/// All that the frames so far have left; whoever begins again makes it anew. Memory that only serves as such
/// (images, workspaces) is elsewhere.
struct Tracking {
  Tracking(const Config& config, const SensorRig& rig) : model(config.tsdf), relocalisation(config, rig) {}

  TsdfVolume model;
  Relocalisation relocalisation;
  std::optional<GaussianState> estimate;  ///< after the last frame
  std::int64_t timestamp_ns = 0;          ///< capture instant of the last frame
  int frames = 0;                         ///< since the start
  int lost_frames = 0;                    ///< in a row, before the current one
  OcclusionGate occlusion_gate;
  ResidualScale residual_scale;          ///< what the residuals of the frames so far showed
  std::vector<Patch> patches;            ///< cut from the last fused frame
  std::int64_t reference_ns = 0;         ///< capture instant of that frame
  std::vector<TrackedCentre> survivors;  ///< where the good patches are in the current frame
};

}  // namespace fusebench
