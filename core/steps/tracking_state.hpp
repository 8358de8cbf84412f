// The state of the estimator between frames.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/acceptance/fusion_gate.hpp"
#include "core/estimator/alignment/tracking_reference.hpp"
#include "core/estimator/filter/color_drift.hpp"
#include "core/estimator/filter/filter_state.hpp"
#include "core/estimator/measurement/residual_scale.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"
#include "core/estimator/patches/patches.hpp"
#include "core/estimator/places/loops/loop_closure.hpp"
#include "core/estimator/places/loops/pending_revisits.hpp"
#include "core/estimator/places/relocalisation/relocalisation.hpp"
#include "core/estimator/prediction/motion_prior.hpp"
#include "core/steps/repeated_images.hpp"

namespace fusebench::core {

/// Prior information on the first frame.
struct Beginning {
  /// restart: initial velocities are those of this state
  std::optional<filter::FilterState> motion = std::nullopt;
  std::optional<filter::GaussianState> state = std::nullopt;  ///< segment: complete state at its first frame
};

/// Complete state of tracking after a frame; a restart replaces it. Stateless buffers (images, workspaces)
/// are stored elsewhere.
struct Tracking {
  Tracking(const config::Config& config, const SensorRig& rig, Beginning begins_with = {});

  Beginning beginning;
  tsdf::TsdfVolume model;
  relocalisation::Relocalisation relocalisation;
  loops::LoopClosure loops;
  loops::PendingRevisits revisits;
  std::optional<filter::GaussianState> estimate;  ///< after the last frame
  prediction::MotionScale motion_scale;           ///< of the tracked frames
  std::int64_t timestamp_ns = 0;                  ///< capture instant of the last frame
  std::int64_t located_ns = 0;                    ///< capture instant of the last frame that was not lost
  int frames = 0;                                 ///< since the start
  double turned_rad = 0;                          ///< total rotation since the start
  int lost_frames = 0;                            ///< consecutive, before the current one
  bool carried_on = false;  ///< the pose of the last frame is predicted from the velocity alone
  RepeatedImages repeated_images;
  acceptance::FusionGate fusion_gate;
  filter::ColorDrift color_drift;
  measurement::ResidualScale residual_scale;      ///< noise scale estimated from earlier frames
  alignment::TrackingReference reference;         ///< from the last fused frame
  std::vector<patches::TrackedCentre> survivors;  ///< positions of the surviving patches in the current frame
};

}  // namespace fusebench::core
