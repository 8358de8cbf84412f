// Histograms of durations in JSON documents.
#pragma once

#include <nlohmann/json.hpp>

#include "eval/record/duration_histogram.hpp"

namespace fusebench::record {

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
