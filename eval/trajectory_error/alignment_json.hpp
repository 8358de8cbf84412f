// Alignments in JSON documents.
#pragma once

#include <nlohmann/json.hpp>

#include "eval/trajectory_error/ate_rpe.hpp"

namespace fusebench::trajectory_error {

/// {"mode", "matrix"}: 16 numbers, row by row.
[[nodiscard]] inline nlohmann::ordered_json json_of(const Alignment& alignment) {
  return {{"mode", alignment.mode}, {"matrix", matrix_of(alignment.T_reference_estimate)}};
}

}  // namespace fusebench::trajectory_error
