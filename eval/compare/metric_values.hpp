// The numbers of a run that are gated: what they are called, which way is worse, and where a record has them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "eval/record/record.hpp"

namespace fusebench::compare {

/// Which change of a number is for the better.
enum class BetterValue {
  smaller,
  larger,
  equal,  ///< none: every change counts as a regression
};
[[nodiscard]] std::string_view to_string(BetterValue better);

/// A number that the same binary, recording and configuration give again, to the last bit.
struct GatedMetric {
  std::string_view key;
  std::string_view unit;   ///< SI; "1" for shares
  std::string_view title;  ///< a few words
  BetterValue better = BetterValue::smaller;
  bool is_count = false;  ///< of frames or of parts of the model: exact unless gates name it
  record::Outcome<double> (*of)(const record::RunRecord&) =
      nullptr;  ///< finite, or the reason why there is none
};
[[nodiscard]] std::span<const GatedMetric> gated_metrics();

/// "0.0123 m"; six digits, and no unit for shares.
[[nodiscard]] std::string quantity_text(double value, std::string_view unit);

/// A number that is never the same twice; less is better in all of them.
struct TimedQuantity {
  std::string_view key;
  std::string_view unit;
  std::string_view title;
  double factor = 1;  ///< default of the ratio of medians that fails
  std::optional<double> (*of)(const record::RunRecord&) = nullptr;  ///< above 0, or absent
};
[[nodiscard]] std::span<const TimedQuantity> timed_quantities();

}  // namespace fusebench::compare
