// The camera, the loops and the histograms of durations in a record, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "eval/record/duration_histogram.hpp"
#include "eval/record/record.hpp"

namespace fusebench::record {

/// The value of "camera": the tables "color" and "depth".
[[nodiscard]] nlohmann::ordered_json json_of_camera(const RecordedCamera& camera);

/// Throws the exceptions of the JSON library for what is missing, and std::invalid_argument for a number
/// that no calibration may have: it may be used to read images.
[[nodiscard]] RecordedCamera camera_of(const nlohmann::ordered_json& json);

/// The value of "loops": the errors, or {"error": null, "reason": ...}.
[[nodiscard]] nlohmann::ordered_json json_of_loops(const Outcome<loop_error::LoopError>& loops);

/// Throws the exceptions of the JSON library for what is missing or wrong.
[[nodiscard]] Outcome<loop_error::LoopError> loops_of(const nlohmann::ordered_json& json);

/// {"count", "min", "median", "p90", "p99", "max", "edges", "counts"}; all but counts in milliseconds.
[[nodiscard]] inline nlohmann::ordered_json json_of(const DurationHistogram& histogram) {
  return {{"count", histogram.count},    {"min", histogram.min_ms},   {"median", histogram.median_ms},
          {"p90", histogram.p90_ms},     {"p99", histogram.p99_ms},   {"max", histogram.max_ms},
          {"edges", histogram.edges_ms}, {"counts", histogram.counts}};
}

/// Throws what the library throws of a key that is missing or of another type.
inline void read(const nlohmann::ordered_json& json, DurationHistogram& histogram) {
  histogram.count = json.at("count");
  histogram.min_ms = json.at("min");
  histogram.median_ms = json.at("median");
  histogram.p90_ms = json.at("p90");
  histogram.p99_ms = json.at("p99");
  histogram.max_ms = json.at("max");
  histogram.edges_ms = json.at("edges").get<std::vector<double>>();
  histogram.counts = json.at("counts").get<std::vector<std::size_t>>();
}

}  // namespace fusebench::record
