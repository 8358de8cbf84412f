// Bars in a JSON document.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "eval/study/bar_check.hpp"

namespace fusebench::study {

/// A list with an object for each bar, keys in a fixed order.
[[nodiscard]] nlohmann::ordered_json bars_json(const std::vector<BarResult>& bars);

}  // namespace fusebench::study
