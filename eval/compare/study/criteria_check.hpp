// Whether a study's runs meet the suite's acceptance criteria.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eval/compare/study/study.hpp"
#include "eval/suites/acceptance_criteria.hpp"

namespace fusebench::study {

enum class Verdict {
  passed,
  tied,  ///< passed by less than the noise of the number, so that it might as well have failed
  failed,
  not_applicable,  ///< no run has such a number: nothing was decided
};
[[nodiscard]] std::string_view to_string(Verdict verdict);  ///< "PASS", "TIE", "FAIL", "n.a."

/// A criterion, evaluated on one split.
struct CriterionMeasurement {
  std::string split;
  Verdict verdict = Verdict::not_applicable;
  std::optional<double> measured;
  /// Standard error of a mean over at least three recordings (jackknife: from the means without each one).
  std::optional<double> noise;
  std::size_t recordings = 0;  ///< that went into the number
  std::string limit;           ///< "<= 0.01", "0.8 .. 1.2", "0.51 .. 1.65 (95 % of 8 runs)"
  std::string note;  ///< the worst recording; runs without the number; empty if there is nothing to say
};

/// The split of the criterion decides; the other one is next to it.
struct CriterionResult {
  suites::Criterion criterion;
  CriterionMeasurement decided;
  CriterionMeasurement beside;
};

/// A run of the criterion's variant that was lost or failed, or lacks the number while others have it, fails
/// the criterion, unless the criterion counts lost runs. Where the run that it is compared with is not ok,
/// the recording is left out, and the note says so.
[[nodiscard]] std::vector<CriterionResult> check_criteria(const Study& study,
                                                          std::span<const suites::Criterion> criteria);

}  // namespace fusebench::study
