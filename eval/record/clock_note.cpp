#include "eval/record/clock_note.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace fusebench::record {

namespace {

constexpr std::string_view kClockOption = "evaluation.reference_time_offset";

bool fit_requested(const RunRecord& record) {
  return std::ranges::any_of(record.config, [](const RecordedOption& option) {
    return option.key == kClockOption && option.value == config::OptionValue{std::string("fitted")};
  });
}

std::string offset_text(const reference_clock::TimeOffset& offset) {
  const int decimals = offset.sigma_s < 1e-3 ? 1 : 0;
  return fmt::format("{:.{}f} +- {:.{}f} ms", 1e3 * offset.offset_s, decimals, 1e3 * offset.sigma_s,
                     decimals);
}

}  // namespace

std::optional<std::string> clock_note(const RunRecord& record) {
  if (record.recording.truth == "none") return std::nullopt;
  const Outcome<reference_clock::ReferenceClock>& clock = record.metrics.reference_clock;
  if (!clock.value) {
    if (!fit_requested(record)) return std::nullopt;
    return fmt::format("{} = fitted changes nothing: {}", kClockOption, clock.reason);
  }
  if (clock.value->applied || !clock.value->offset.significant()) return std::nullopt;
  std::string note = fmt::format("the reference clock is {} off; ", offset_text(clock.value->offset));
  const std::optional<double>& fitted_m = clock.value->fitted.ate_rmse_m;
  const std::optional<double>& as_read_m = clock.value->as_read.ate_rmse_m;
  if (fitted_m && as_read_m) {
    note += fmt::format("ATE {:.2f} instead of {:.2f} cm with", 100 * *fitted_m, 100 * *as_read_m);
  } else {
    note += "corrected with";
  }
  return note + fmt::format(" --set {}=fitted", kClockOption);
}

}  // namespace fusebench::record
