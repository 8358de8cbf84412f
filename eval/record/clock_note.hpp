// The sentence about the clock of a run's ground truth.
#pragma once

#include <optional>
#include <string>

#include "eval/record/record.hpp"

namespace fusebench::record {

/// "the reference clock is 66 +- 2 ms off; ATE 4.10 instead of 5.20 cm with --set
/// evaluation.reference_time_offset=fitted" where a significant offset is not applied, and why `fitted`
/// changes nothing where the offset is not observable. Nothing in all other cases.
[[nodiscard]] std::optional<std::string> clock_note(const RunRecord& record);

}  // namespace fusebench::record
