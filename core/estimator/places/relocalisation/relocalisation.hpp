// Relocalisation of a lost camera by keyframes. The paper leaves this open.
//
// Candidates are found by features or, with too few features, by depth (keyframes.hpp). The candidate with
// sufficient posterior odds (place_odds.hpp) updates the filter (relocalisation_update.hpp), and tracking
// continues with patches of the matched keyframe.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/alignment/tracking_reference.hpp"
#include "core/estimator/filter/filter_state.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"
#include "core/estimator/places/relocalisation/keyframes.hpp"
#include "core/estimator/places/relocalisation/place_odds.hpp"
#include "core/estimator/places/relocalisation/relocalisation_update.hpp"

namespace fusebench::relocalisation {

/// State and reference for tracking after a relocalisation.
struct RelocalisedReference {
  filter::GaussianState prior;             ///< after the relocalisation update
  alignment::TrackingReference reference;  ///< cut from the matched keyframe
  bool by_depth = false;                   ///< relocalised by depth, without features
};

/// Images of a frame that can be used for relocalisation.
struct UsableImages {
  bool grey = true;   ///< not dark
  bool depth = true;  ///< not a repeated image
};

class Relocalisation {
 public:
  /// The references must outlive it.
  Relocalisation(const config::Config& config, const SensorRig& rig);

  /// Offers a tracked and fused frame (compensated, gated) as a keyframe.
  void add_keyframe(const RgbdFrame& frame, const SE3& T_world_camera, std::int64_t timestamp_ns,
                    double blur_px);

  /// Sets the corrected poses of the keyframes, by their stamps.
  void move(const std::function<SE3(std::int64_t timestamp_ns)>& T_world_camera_at) {
    keyframes_.move(T_world_camera_at);
    odds_.clear();
  }

  /// Takes over the keyframes of a segment that was joined to this map.
  void adopt(const Relocalisation& joined, const SE3& T_world_joined) {
    keyframes_.adopt(joined.keyframes_, T_world_joined);
  }

  /// Relocalises the frame by the keyframes; nothing if no match is certain or if the odds are too small.
  [[nodiscard]] std::optional<RelocalisedReference> find(const RgbdFrame& frame, const UsableImages& usable,
                                                         const filter::GaussianState& prediction,
                                                         const tsdf::TsdfVolume& model,
                                                         const Workers& workers);

 private:
  [[nodiscard]] RelocalisedPose pose_of(const FoundPlace& found) const;
  [[nodiscard]] std::optional<FoundPlace> likely_one(const std::vector<FoundPlace>& candidates,
                                                     const filter::GaussianState& prediction);
  [[nodiscard]] std::optional<FoundPlace> place_of(const RgbdFrame& frame, const UsableImages& usable,
                                                   const filter::GaussianState& prediction);

  const config::Config& config_;
  const SensorRig& rig_;
  Keyframes keyframes_;
  PlaceOdds odds_;
};

}  // namespace fusebench::relocalisation
