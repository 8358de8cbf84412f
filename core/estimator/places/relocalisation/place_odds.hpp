// Selection among ambiguous candidates by posterior odds, with dead reckoning as the prior.
//
// Hypotheses: each verified candidate, and another place with the same appearance that is not in the map. The
// prior density p of a pose is a Student t distribution around the dead-reckoned pose, with the covariance of
// dead reckoning plus that of the candidate. Its tails cover a filter that was wrong before the loss. Similar
// places by accident are a Poisson process in position and orientation. If two candidates are apart from each
// other, the scene repeats, and another similar place is expected at the same distance (doors of a corridor).
//
// odds of candidate i = p(x_i) / (sum of p(x_j), j elsewhere + p(x_i + spacing) + density of look-alikes)
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/filter_state.hpp"
#include "core/estimator/places/relocalisation/relocalisation_update.hpp"

namespace fusebench::relocalisation {

/// Prior density of the pose of a place (per cubic metre and cubic radian).
[[nodiscard]] double pose_density(const filter::GaussianState& prediction, const RelocalisedPose& place);

/// True if the distance of the cameras exceeds twice the keyframe spacing, more than two views of one place
/// under drift of the model.
[[nodiscard]] bool are_elsewhere(const SE3& T_world_a, const SE3& T_world_b,
                                 const config::RelocalisationConfig& config);

/// The decision, from the first lost frame until the camera is tracked again.
class PlaceOdds {
 public:
  /// The configuration must outlive it.
  explicit PlaceOdds(const config::RelocalisationConfig& config) : config_(config) {}

  /// Index of the accepted candidate, if its odds are at least relocalisation.min_odds; the first one of
  /// candidates at the same place. Candidates: best first.
  [[nodiscard]] std::optional<std::size_t> decide(std::span<const RelocalisedPose> candidates,
                                                  const filter::GaussianState& prediction);

  /// Call it when the camera is tracked or poses have moved.
  void clear() { spacing_m_.reset(); }

 private:
  void measure_spacing(std::span<const RelocalisedPose> candidates);
  [[nodiscard]] double density_at_spacing(const RelocalisedPose& place,
                                          const filter::GaussianState& prediction) const;

  const config::RelocalisationConfig& config_;
  std::optional<double> spacing_m_;  ///< smallest distance of two ambiguous candidates
};

}  // namespace fusebench::relocalisation
