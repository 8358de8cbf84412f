// The offset of a reference's clock in JSON documents.
#pragma once

#include <nlohmann/json.hpp>

#include "eval/metrics/reference_clock/clocked_errors.hpp"

namespace fusebench::reference_clock {

/// {"ate_rmse_m", "rpe_1s_m", "rpe_1s_rad", "silent_failures"}; null where there is no number.
[[nodiscard]] inline nlohmann::ordered_json json_of(const ClockedErrors& errors) {
  const auto number = [](const auto& value) -> nlohmann::ordered_json {
    if (!value) return nullptr;
    return *value;
  };
  return {{"ate_rmse_m", number(errors.ate_rmse_m)},
          {"rpe_1s_m", number(errors.rpe_1s_m)},
          {"rpe_1s_rad", number(errors.rpe_1s_rad)},
          {"silent_failures", number(errors.silent)}};
}

/// {"protocol", "applied", "motions", "offset_s", "sigma_s", "significant", "as_read", "fitted"}.
[[nodiscard]] inline nlohmann::ordered_json json_of(const ReferenceClock& clock) {
  return {{"protocol", kClockProtocol},        {"applied", clock.applied ? "fitted" : "none"},
          {"motions", clock.offset.motions},   {"offset_s", clock.offset.offset_s},
          {"sigma_s", clock.offset.sigma_s},   {"significant", clock.offset.significant()},
          {"as_read", json_of(clock.as_read)}, {"fitted", json_of(clock.fitted)}};
}

}  // namespace fusebench::reference_clock
