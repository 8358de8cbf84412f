// Do the runs of a study reach a bar?
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eval/study/study.hpp"
#include "eval/suites/suite_bars.hpp"

namespace fusebench::study {

enum class Verdict {
  passed,
  failed,
  not_applicable,  ///< no run has such a number: nothing was decided
};
[[nodiscard]] std::string_view to_string(Verdict verdict);  ///< "PASS", "FAIL", "n.a."

/// A bar on one half.
struct BarMeasurement {
  std::string half;
  Verdict verdict = Verdict::not_applicable;
  std::optional<double> measured;
  std::size_t recordings = 0;  ///< that went into the number
  std::string limit;           ///< "<= 0.01", "0.8 .. 1.2", "0.51 .. 1.65 (95 % of 8 runs)"
  std::string note;  ///< the worst recording; runs without the number; empty if there is nothing to say
};

/// The half of the bar decides; the other one stands beside it.
struct BarResult {
  suites::Bar bar;
  BarMeasurement decided;
  BarMeasurement beside;
};

/// A run of the bar's variant that was lost or failed, or lacks the number while others have it, fails the
/// bar, unless the bar counts lost runs. Where the run that it is compared with is not ok, the recording is
/// left out, and the note says so.
[[nodiscard]] std::vector<BarResult> check_bars(const Study& study, std::span<const suites::Bar> bars);

}  // namespace fusebench::study
