// Places that look alike: an image of one door of a corridor shows every door, and no image tells which. The
// door that the camera stands before may even be one that was never seen. So where places repeat, one is
// believed only if dead reckoning tells it from its neighbours at that distance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/relocalisation/keyframes.hpp"

namespace fusebench::relocalisation {

/// Whether the cameras are further apart than drift moves one and the same place
/// (relocalisation.rival_separation).
[[nodiscard]] bool is_elsewhere(const SE3& T_world_a, const SE3& T_world_b,
                                const config::RelocalisationConfig& config);

/// Where dead reckoning has the camera.
struct PredictedPosition {
  Vector3d world_m = Vector3d::Zero();
  double sigma_m = 0;  ///< along the axis where it is largest
};

class RivalPlaces {
 public:
  /// The configuration must outlive it.
  explicit RivalPlaces(const config::RelocalisationConfig& config) : config_(config) {}

  /// The places that an image fits (best first): if some of them are elsewhere, all are remembered for
  /// relocalisation.rivals_within_s. Stamps ascend.
  void observe(std::int64_t timestamp_ns, std::span<const FoundPlace> best_first);

  /// True if, of the places that the prediction allows (best first, at least one), the first is the only one,
  /// and dead reckoning tells it from its neighbours. If there were rivals lately, and it is not further from
  /// all of them than the two were from each other that were furthest apart, it has to be nearer to the
  /// prediction than half the distance of the nearest two, and so do three of its standard deviations.
  [[nodiscard]] bool is_only_one(std::int64_t timestamp_ns, std::span<const FoundPlace> allowed,
                                 const PredictedPosition& predicted) const;

  /// The camera is tracked, or poses have moved.
  void clear() { rivals_world_m_.clear(); }

 private:
  [[nodiscard]] bool repeats_near(std::int64_t timestamp_ns, const Vector3d& position_m) const;

  const config::RelocalisationConfig& config_;
  std::int64_t timestamp_ns_ = 0;
  std::vector<Vector3d> rivals_world_m_;  ///< the last ones; empty: there were none
  double nearest_m_ = 0;                  ///< distances between two of them
  double furthest_m_ = 0;
};

}  // namespace fusebench::relocalisation
