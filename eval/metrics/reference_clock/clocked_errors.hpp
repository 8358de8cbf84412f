// Errors of an estimate with the reference's clock as it is read, and with its fitted offset.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/reference_clock/time_offset.hpp"

namespace fusebench::reference_clock {

/// The numbers that an offset of the clock moves most; those that cannot be computed are absent.
struct ClockedErrors {
  std::optional<double> ate_rmse_m;
  std::optional<double> rpe_1s_m;  ///< rmse over 1 s
  std::optional<double> rpe_1s_rad;
  std::optional<std::size_t> silent;  ///< undetected failures
};

/// The fitted offset, and what it changes.
struct ReferenceClock {
  TimeOffset offset;
  bool applied = false;  ///< whether the main numbers of a run are those with the offset
  ClockedErrors as_read;
  ClockedErrors fitted;
};

/// The definition in one sentence, for records and reports.
inline constexpr std::string_view kClockProtocol =
    "t_reference = t_estimate + offset; estimating equation of the motions over 0.5 s, the transform of the "
    "bodies "
    "fitted as well";

/// The reference on the estimate's clock: offset_s is subtracted from its stamps.
[[nodiscard]] Trajectory on_estimate_clock(Trajectory reference, double offset_s);

/// ATE and RPE over 1 s by TUM's protocol, and undetected failures by their default limits.
[[nodiscard]] ClockedErrors clocked_errors(const Trajectory& reference, const Trajectory& estimate);

/// Fits the offset and computes both errors. Errors: those of fitted_time_offset().
[[nodiscard]] Result<ReferenceClock> fitted_reference_clock(const Trajectory& reference,
                                                            const Trajectory& estimate);

}  // namespace fusebench::reference_clock
