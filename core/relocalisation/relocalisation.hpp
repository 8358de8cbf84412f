// Where a lost camera is, by the frames that were fused before. The paper leaves this open.
//
// Candidates are found by features or, where there are too few, by depth (keyframes.hpp).
// The one whose posterior odds suffice (place_odds.hpp) updates the filter (relocalisation_update.hpp), and
// tracking goes on with patches of its keyframe.
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
#include "core/relocalisation/keyframes.hpp"
#include "core/relocalisation/place_odds.hpp"
#include "core/relocalisation/relocalisation_update.hpp"
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
    odds_.clear();
  }

  /// Takes over the keyframes of a model that was joined to this one.
  void adopt(const Relocalisation& joined, const SE3& T_world_joined) {
    keyframes_.adopt(joined.keyframes_, T_world_joined);
  }

  /// Looks for the frame among the keyframes; nothing if none shows its place for certain, or if the odds of
  /// the likeliest place are too small.
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
