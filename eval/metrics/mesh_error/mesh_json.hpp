// Errors of meshes in JSON documents.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

#include "eval/metrics/mesh_error/mesh_metrics.hpp"

namespace fusebench::mesh_error {

/// Statistics, p90 and p95; null of no values.
[[nodiscard]] nlohmann::ordered_json json_of(const MeshDistances& distances);

/// {"alignment", "accuracy", "completeness", "chamfer_m", "thresholds"}.
[[nodiscard]] nlohmann::ordered_json json_of(const MeshErrorResult& mesh);

/// {"from", "count", "seed", "points"}; points: how many there are.
[[nodiscard]] nlohmann::ordered_json json_of(const MeshSampling& sampling, std::size_t points);

}  // namespace fusebench::mesh_error
