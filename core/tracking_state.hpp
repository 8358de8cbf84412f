// What the estimator carries from frame to frame.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/config.hpp"
#include "core/filter/filter_state.hpp"
#include "core/health/update_acceptance.hpp"
#include "core/measurement/residual_scale.hpp"
#include "core/patches/patches.hpp"
#include "core/relocalisation/relocalisation.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::core {

/// All that the frames so far have left; whoever begins again makes it anew. Memory that only serves as such
/// (images, workspaces) is elsewhere.
struct Tracking {
  Tracking(const config::Config& config, const SensorRig& rig)
      : model(config.tsdf), relocalisation(config, rig) {}

  tsdf::TsdfVolume model;
  relocalisation::Relocalisation relocalisation;
  std::optional<filter::GaussianState> estimate;  ///< after the last frame
  std::int64_t timestamp_ns = 0;                  ///< capture instant of the last frame
  int frames = 0;                                 ///< since the start
  int lost_frames = 0;                            ///< in a row, before the current one
  health::OcclusionGate occlusion_gate;
  measurement::ResidualScale residual_scale;      ///< what the residuals of the frames so far showed
  std::vector<patches::Patch> patches;            ///< cut from the last fused frame
  std::int64_t reference_ns = 0;                  ///< capture instant of that frame
  std::vector<patches::TrackedCentre> survivors;  ///< where the good patches are in the current frame
};

}  // namespace fusebench::core
