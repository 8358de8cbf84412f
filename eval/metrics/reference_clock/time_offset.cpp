#include "eval/metrics/reference_clock/time_offset.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "eval/metrics/reference_clock/body_motions.hpp"
#include "eval/metrics/reference_clock/offset_fit.hpp"

namespace fusebench::reference_clock {

namespace {

constexpr std::size_t kMostPoses = 10'000;
constexpr std::size_t kFewestMotions = 30;
constexpr double kFewestSeconds = 2.5;

/// What is missing for an offset; nothing of a good fit.
Result<void> check_fit(const OffsetFit& fit) {
  if (fit.motions < kFewestMotions || fit.independent < kFewestSeconds) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("the clock offset is not observable: {} motions of 0.5 s over {:.1f} s have a "
                            "reference (needed: {} over {:g} s)",
                            fit.motions, fit.independent, kFewestMotions, kFewestSeconds));
  }
  if (!std::isfinite(fit.sigma_s))
    return fail(ErrorCode::data_corrupt,
                "the clock offset is not observable: speed and turning rate do not change in common");
  if (fit.sigma_s > kMostSigma_s) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("the clock offset is not observable: its standard deviation is {:.0f} ms "
                            "(allowed: up to {:g} ms)",
                            1e3 * fit.sigma_s, 1e3 * kMostSigma_s));
  }
  return {};
}

}  // namespace

bool TimeOffset::significant() const {
  constexpr double kSigmas = 5;
  constexpr double kLeast_s = 0.01;
  return std::abs(offset_s) > kSigmas * sigma_s && std::abs(offset_s) > kLeast_s;
}

Result<TimeOffset> fitted_time_offset(const Trajectory& reference, const Trajectory& estimate) {
  const std::vector<EstimatedMotion> motions = estimated_motions(estimate, kMostPoses);
  const std::vector<OffsetCandidate> profile = offset_profile(reference, motions);
  const OffsetFit fit = profile.empty() ? OffsetFit{} : fitted_from(best_of(profile), reference, motions);
  if (auto good = check_fit(fit); !good) return tl::unexpected(good.error());
  if (std::abs(fit.offset_s) > kLargestOffset_s) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("the clock offset is beyond the range of -{0:g} to {0:g} s that is searched",
                            kLargestOffset_s),
                "move the stamps of the estimate first (--t_offset)");
  }
  if (const auto ambiguous = ambiguous_candidate(best_of(profile), profile, fit.independent)) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("the clock offset is ambiguous: {:.0f} ms and about {:.0f} ms fit alike",
                            1e3 * fit.offset_s, 1e3 * ambiguous->offset_s),
                "the motion repeats itself; it has to be irregular");
  }
  return TimeOffset{fit.offset_s, fit.sigma_s, fit.motions};
}

}  // namespace fusebench::reference_clock
