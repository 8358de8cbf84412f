// The consistency of a trajectory's covariances, for people, programs and papers.
#pragma once

#include <string>

#include "eval/metrics/trajectory_error/pose_nees.hpp"
#include "eval/page/page.hpp"
#include "eval/report/metric_reports/trajectory_report.hpp"

namespace fusebench::metric_reports {

/// The request; the reference is interpolated.
struct ConsistencyQuestion {
  ComparedFiles files;
  trajectory_files::AssociationOptions association;
  trajectory_error::AlignmentRequest alignment;
};

[[nodiscard]] std::string to_text(const trajectory_error::PoseConsistency& consistency,
                                  const ConsistencyQuestion& question);

/// {"metric": "nees", "pairs", "possible", "coverage", "singular", "association", "alignment", "orientation",
/// "position"}; either part has nees_per_dof (statistics), error_rmse, sigma_rms and share_within_3_sigma.
[[nodiscard]] std::string to_json(const trajectory_error::PoseConsistency& consistency,
                                  const ConsistencyQuestion& question);

/// A row a pose: errors, standard deviations (rad and m, by axis) and NEES of both parts.
[[nodiscard]] std::string consistency_csv(const trajectory_error::PoseConsistency& consistency);

/// Errors by axis within their 3 sigma, and NEES over time.
[[nodiscard]] std::vector<page::Chart> consistency_charts(
    const trajectory_error::PoseConsistency& consistency);

}  // namespace fusebench::metric_reports
