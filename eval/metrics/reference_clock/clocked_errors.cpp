#include "eval/metrics/reference_clock/clocked_errors.hpp"

#include <cmath>
#include <utility>

#include "core/base/trajectory/trajectory.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/metrics/trajectory_error/silent_failures.hpp"

namespace fusebench::reference_clock {

Trajectory on_estimate_clock(Trajectory reference, double offset_s) {
  return trajectory::with_clock_offset(std::move(reference), -std::llround(1e9 * offset_s));
}

ClockedErrors clocked_errors(const Trajectory& reference, const Trajectory& estimate) {
  ClockedErrors errors;
  if (const auto ate = trajectory_error::absolute_trajectory_error(reference, estimate))
    errors.ate_rmse_m = ate->stats.rmse;
  if (const auto rpe = trajectory_error::relative_pose_error(reference, estimate)) {
    errors.rpe_1s_m = rpe->translation.rmse;
    errors.rpe_1s_rad = rpe->rotation.rmse;
  }
  if (const auto failures = trajectory_error::silent_failures(reference, estimate))
    errors.silent = failures->silent;
  return errors;
}

Result<ReferenceClock> fitted_reference_clock(const Trajectory& reference, const Trajectory& estimate) {
  const auto offset = fitted_time_offset(reference, estimate);
  if (!offset) return tl::unexpected(offset.error());
  return ReferenceClock{*offset, false, clocked_errors(reference, estimate),
                        clocked_errors(on_estimate_clock(reference, offset->offset_s), estimate)};
}

}  // namespace fusebench::reference_clock
