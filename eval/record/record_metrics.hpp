// The metrics of a record as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "eval/record/record.hpp"

namespace fusebench::record {

/// The value of "metrics". Numbers that do not exist are null; a metric without result has a reason.
[[nodiscard]] nlohmann::ordered_json json_of_metrics(const RecordedMetrics& metrics,
                                                     const RecordedFrames& frames);

/// Fills metrics from it; those that earlier versions did not know may be absent. Throws the exceptions of
/// the JSON library for what is missing or wrong.
void read_metrics(const nlohmann::ordered_json& json, RecordedMetrics& metrics);

}  // namespace fusebench::record
