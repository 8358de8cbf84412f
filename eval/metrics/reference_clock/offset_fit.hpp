// Which constant offset between the clocks explains the motions best: searched on a grid, then fitted.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "eval/metrics/reference_clock/body_motions.hpp"
#include "eval/metrics/reference_clock/body_transform.hpp"

namespace fusebench::reference_clock {

/// Offsets are searched from -0.5 to 0.5 s.
inline constexpr double kLargestOffset_s = 0.5;

/// How well motions of reference and estimate agree at an offset.
struct OffsetCandidate {
  double offset_s = 0;
  double misfit = 0;  ///< mean norm of the residuals, in units of 1 cm and 10 mrad
  BodyTransform transform;
};

/// Up to 400 of the motions, evenly spread, at all offsets from -0.5 to 0.5 s in steps of 20 ms. Offsets at
/// which the reference is known for fewer than 30 of them, or for fewer than half, are left out.
[[nodiscard]] std::vector<OffsetCandidate> offset_profile(const Trajectory& reference,
                                                          std::span<const EstimatedMotion> motions);

/// The offset of the smallest misfit; the profile is not empty.
[[nodiscard]] const OffsetCandidate& best_of(std::span<const OffsetCandidate> profile);

/// A local minimum of the profile at least 0.1 s from the best one whose misfit exceeds its by less than a
/// share of 1.5 / sqrt(duration): three standard deviations of a mean of norms, of which as many are
/// independent as there are seconds, each with a relative scatter of a half.
[[nodiscard]] std::optional<OffsetCandidate> ambiguous_candidate(const OffsetCandidate& best,
                                                                 std::span<const OffsetCandidate> profile,
                                                                 double duration_s);

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
