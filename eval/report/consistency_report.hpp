// The consistency of a trajectory's covariances, for people, programs and papers.
#pragma once

#include <string>

#include "eval/report/page.hpp"
#include "eval/report/trajectory_report.hpp"
#include "eval/trajectory/pose_consistency.hpp"

namespace fusebench {

/// Which question was asked; the reference was interpolated.
struct ConsistencyQuestion {
  ComparedFiles files;
  AssociationOptions association;
  AlignmentRequest alignment;
};

[[nodiscard]] std::string to_text(const PoseConsistency& consistency, const ConsistencyQuestion& question);

/// {"metric": "nees", "pairs", "possible", "coverage", "singular", "association", "alignment", "orientation",
/// "position"}; either part has nees_per_dof (statistics), error_rmse, sigma_rms and share_within_3_sigma.
[[nodiscard]] std::string to_json(const PoseConsistency& consistency, const ConsistencyQuestion& question);

/// A row a pose: errors, standard deviations (rad and m, by axis) and NEES of both parts.
[[nodiscard]] std::string consistency_csv(const PoseConsistency& consistency);

/// Errors by axis within their 3 sigma, and NEES over time.
[[nodiscard]] std::vector<Chart> consistency_charts(const PoseConsistency& consistency);

}  // namespace fusebench
