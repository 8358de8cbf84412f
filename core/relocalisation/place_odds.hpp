// Which of the places that an image was found at the camera is at: posterior odds, with dead reckoning as the
// prior.
//
// Hypotheses: each candidate (its images fit the frame, verified); another place that looks like it and is
// not in the map. The prior density of a pose is a Student t distribution around the dead-reckoned pose, with
// the covariance that dead reckoning and the candidate claim: its tails are those of a filter that was wrong
// before it was lost. Places that look like a candidate by accident are spread at random (a Poisson process
// in position and orientation). If two candidates lie apart from each other, the scene repeats itself, and a
// further place is to be expected at the same distance as these two have (doors of a corridor).
//
//   odds of candidate i = p(x_i) / (sum of p(x_j), j elsewhere + p(x_i + spacing) + density of look-alikes)
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"
#include "core/relocalisation/relocalisation_update.hpp"

namespace fusebench::relocalisation {

/// Prior density of the pose of a place (per cubic metre and cubic radian).
[[nodiscard]] double pose_density(const filter::GaussianState& prediction, const RelocalisedPose& place);

/// True if the cameras are further apart than two views of one place that the model has drifted between:
/// twice the spacing of keyframes.
[[nodiscard]] bool are_elsewhere(const SE3& T_world_a, const SE3& T_world_b,
                                 const config::RelocalisationConfig& config);

/// The decision, from the first frame that is lost until the camera is tracked again.
class PlaceOdds {
 public:
  /// The configuration must outlive it.
  explicit PlaceOdds(const config::RelocalisationConfig& config) : config_(config) {}

  /// The index of the candidate that the camera is at, if its odds are at least relocalisation.min_odds; of
  /// candidates at the same place the first. Candidates: best first.
  [[nodiscard]] std::optional<std::size_t> decide(std::span<const RelocalisedPose> candidates,
                                                  const filter::GaussianState& prediction);

  /// The camera is tracked, or poses have moved.
  void clear() { spacing_m_.reset(); }

 private:
  void measure_spacing(std::span<const RelocalisedPose> candidates);
  [[nodiscard]] double density_at_spacing(const RelocalisedPose& place,
                                          const filter::GaussianState& prediction) const;

  const config::RelocalisationConfig& config_;
  std::optional<double> spacing_m_;  ///< the smallest distance of two places that look alike
};

}  // namespace fusebench::relocalisation
