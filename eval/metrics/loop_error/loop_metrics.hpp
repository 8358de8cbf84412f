// What loops are worth, against the ground truth: which returns to a place were found, which loops are false,
// how well they know their own errors, and how much better poses could have become.
#pragma once

#include <cstddef>
#include <optional>

#include "core/base/geometry.hpp"

namespace fusebench::loop_error {

/// A place is a revisit if, by the true poses, it sees at least this share of the surface of a place that was
/// seen loops.least_age_s ago or before.
inline constexpr double kRevisitOverlap = 0.3;
/// A place with more motion blur counts as blurred.
inline constexpr double kBlurred_px = 2.0;
/// A loop that is off by more, and by more than kFalseSigmas of what it claims, is false.
inline constexpr double kFalseTranslation_m = 0.05;
inline constexpr double kFalseRotation_rad = radians(2.0);
inline constexpr double kFalseSigmas = 3.0;

struct Revisits {
  std::size_t count = 0;
  std::size_t found = 0;  ///< those with an accepted loop
};

struct LoopError {
  std::size_t places = 0;  ///< with truth
  Revisits sharp;
  Revisits blurred;
  std::size_t verified = 0;  ///< pairs that passed the checks of their images
  std::size_t accepted = 0;  ///< of these, and those that only the tracker says
  std::size_t false_verified = 0;
  std::size_t false_accepted = 0;
  // Of accepted loops; 0 without one, where records have null.
  double median_translation_m = 0;
  double median_rotation_rad = 0;
  double nees_rotation = 0;  ///< mean by degree of freedom: 1 is consistent
  double nees_position = 0;
  /// ATE of the final poses with a true loop at every revisit in place of those that were found; nothing if
  /// there is no revisit, or if positions cannot be aligned (a camera that does not move).
  std::optional<double> oracle_ate_m;
};

}  // namespace fusebench::loop_error
