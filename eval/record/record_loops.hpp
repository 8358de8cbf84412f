// What a record says of loops, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "eval/record/record.hpp"

namespace fusebench::record {

/// The value of "loops": the errors, or {"error": null, "reason": ...}.
[[nodiscard]] nlohmann::ordered_json json_of_loops(const Outcome<loop_error::LoopError>& loops);

/// Throws the exceptions of the JSON library for what is missing or wrong.
[[nodiscard]] Outcome<loop_error::LoopError> loops_of(const nlohmann::ordered_json& json);

}  // namespace fusebench::record
