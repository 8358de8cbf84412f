// The offset between two clocks from a start that is near it.
#pragma once

#include <cstddef>
#include <span>

#include "core/base/types.hpp"
#include "eval/reference_clock/body_motions.hpp"
#include "eval/reference_clock/body_transform.hpp"
#include "eval/reference_clock/offset_search.hpp"

namespace fusebench::reference_clock {

struct OffsetFit {
  double offset_s = 0;
  double sigma_s = 0;  ///< infinite where no offset is determined
  std::size_t motions = 0;
  double independent = 0;  ///< independent_terms(): seconds of motion that determine the offset
  BodyTransform transform;
  MotionSigmas sigmas;  ///< of the residuals
};

/// Solves the equation of fitted_time_offset() by Newton's method: in each iteration the transform of the
/// bodies by Gauss-Newton with Huber's weights, then the offset, by at most 20 ms. The sigma is infinite if
/// that does not converge within 0.1 s of the start.
[[nodiscard]] OffsetFit fitted_from(const OffsetCandidate& start, const Trajectory& reference,
                                    std::span<const EstimatedMotion> motions);

}  // namespace fusebench::reference_clock
