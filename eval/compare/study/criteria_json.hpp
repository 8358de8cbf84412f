// Acceptance criteria in a JSON document.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "eval/compare/study/criteria_check.hpp"

namespace fusebench::study {

/// A list with an object for each criterion, keys in a fixed order.
[[nodiscard]] nlohmann::ordered_json criteria_json(const std::vector<CriterionResult>& criteria);

}  // namespace fusebench::study
