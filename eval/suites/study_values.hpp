// The numbers of a run that studies summarise and set acceptance criteria on, by name.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "eval/record/record.hpp"

namespace fusebench::suites {

inline constexpr std::string_view kCommonPixelsValue = "aie_common_grey";

/// One number of a run. Values of length are metres, of angle radians.
struct StudyValue {
  std::string_view name;
  std::string_view label;  ///< heading of a table, with the unit that it shows
  double shown_factor = 1;
  int decimals = 2;
  bool higher_is_better = false;
  bool of_every_run = false;  ///< also of runs that were lost or failed; otherwise of ok runs alone
  int nees_dof = 0;           ///< of NEES / dof; 0: it is none
  /// Nothing if the run has no such number; null for the numbers that take two runs.
  std::optional<double> (*of)(const record::RunRecord& record) = nullptr;
};

[[nodiscard]] std::span<const StudyValue> study_values();
/// Null if there is none of that name.
[[nodiscard]] const StudyValue* find_study_value(std::string_view name);

}  // namespace fusebench::suites
