// Alignments, and what is fitted with them, in JSON documents.
#pragma once

#include <nlohmann/json.hpp>

#include "eval/metrics/statistics_json.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/metrics/trajectory_error/fitted_offset.hpp"

namespace fusebench::trajectory_error {

/// {"mode", "matrix"}: 16 numbers, row by row.
[[nodiscard]] inline nlohmann::ordered_json json_of(const Alignment& alignment) {
  return {{"mode", alignment.mode}, {"matrix", matrix_of(alignment.T_reference_estimate)}};
}

/// {"protocol", "unit", "pairs", "offset_m", "offset_sigma_m", "alignment", "stats"}.
[[nodiscard]] inline nlohmann::ordered_json json_of(const FittedOffset& fit) {
  const Vector3d sigma_m = fit.covariance_m2.diagonal().cwiseSqrt();
  return {{"protocol",
           "positions after SE3 alignment and an offset of the reference's body, both by least squares"},
          {"unit", "m"},
          {"pairs", fit.pairs},
          {"offset_m", {fit.offset_m.x(), fit.offset_m.y(), fit.offset_m.z()}},
          {"offset_sigma_m", {sigma_m.x(), sigma_m.y(), sigma_m.z()}},
          {"alignment", json_of(Alignment{"se3", fit.T_reference_estimate})},
          {"stats", metrics::json_of(fit.stats)}};
}

}  // namespace fusebench::trajectory_error
