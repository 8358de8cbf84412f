// Where a lost camera is, by the frames that were fused before. The paper leaves this open.
//
// A pose found by features or, where there are none, by depth (keyframes.hpp) is held against the prediction,
// updates the filter (relocalisation_update.hpp), and is tracked from with patches of the keyframe that
// showed it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/alignment/tracking_reference.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"
#include "core/relocalisation/agreeing_places.hpp"
#include "core/relocalisation/keyframes.hpp"
#include "core/relocalisation/relocalisation_update.hpp"
#include "core/relocalisation/rival_places.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::relocalisation {

/// What tracking goes on from.
struct RelocalisedReference {
  filter::GaussianState prior;             ///< after the relocalisation update
  alignment::TrackingReference reference;  ///< from the keyframe
  bool by_depth = false;                   ///< no features were needed
};

/// What of a frame a place is looked for by.
struct UsableImages {
  bool grey = true;   ///< not dark
  bool depth = true;  ///< not that of an earlier frame
};

class Relocalisation {
 public:
  /// The references must outlive it.
  Relocalisation(const config::Config& config, const SensorRig& rig);

  /// Offers a tracked and fused frame (motion compensated, depth gated) as one to be found again by.
  void add_keyframe(const RgbdFrame& frame, const SE3& T_world_camera, std::int64_t timestamp_ns,
                    double blur_px);

  /// All poses were corrected: those of the keyframes become these, by their stamps.
  void move(const std::function<SE3(std::int64_t timestamp_ns)>& T_world_camera_at) {
    keyframes_.move(T_world_camera_at);
    refused_.clear();
    rivals_.clear();
  }

  /// The motion of the camera by the places of the frames before, where these contradict the prediction: what
  /// dead reckoning says of the velocity would then spoil the images that are compensated for it.
  [[nodiscard]] std::optional<filter::FilterState> motion_by_places(
      std::int64_t timestamp_ns, const filter::FilterState& predicted) const {
    return refused_.motion(timestamp_ns, predicted);
  }

  /// Looks for the frame among the keyframes; nothing if none shows its place for certain, if the prediction
  /// rules the place out and the frames before do not support it (agreeing_places.hpp), or if it allows
  /// several that look alike (rival_places.hpp).
  [[nodiscard]] std::optional<RelocalisedReference> find(const RgbdFrame& frame, const UsableImages& usable,
                                                         const filter::GaussianState& prediction,
                                                         const tsdf::TsdfVolume& model,
                                                         const Workers& workers);

 private:
  /// How far a place may be from the prediction.
  struct Limits {
    double innovation;  ///< squared, in variances, per degree of freedom
    double rotation_rad;
  };
  [[nodiscard]] RelocalisedPose pose_of(const FoundPlace& found) const;
  [[nodiscard]] std::vector<FoundPlace> allowed_places(const std::vector<FoundPlace>& places,
                                                       const filter::GaussianState& prediction,
                                                       const Limits& limits) const;
  [[nodiscard]] std::optional<FoundPlace> supported(const FoundPlace& found, const RgbdFrame& frame,
                                                    const filter::GaussianState& prediction);
  [[nodiscard]] std::optional<FoundPlace> place_of(const RgbdFrame& frame, const UsableImages& usable,
                                                   const filter::GaussianState& prediction);

  const config::Config& config_;
  const SensorRig& rig_;
  Keyframes keyframes_;
  AgreeingPlaces refused_;
  RivalPlaces rivals_;
};

}  // namespace fusebench::relocalisation
