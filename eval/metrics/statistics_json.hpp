// Statistics in JSON documents.
#pragma once

#include <nlohmann/json.hpp>

#include "eval/metrics/statistics.hpp"

namespace fusebench::metrics {

/// {"rmse", "mean", "median", "std", "min", "max", "sse", "count"}; null of no values.
[[nodiscard]] inline nlohmann::ordered_json json_of(const Statistics& stats) {
  if (stats.count == 0) return nullptr;
  return {{"rmse", stats.rmse}, {"mean", stats.mean}, {"median", stats.median}, {"std", stats.std},
          {"min", stats.min},   {"max", stats.max},   {"sse", stats.sse},       {"count", stats.count}};
}

}  // namespace fusebench::metrics
