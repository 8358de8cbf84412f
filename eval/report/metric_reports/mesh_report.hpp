// The evaluation of a mesh, for people and for programs.
#pragma once

#include <string>

#include "eval/metrics/mesh_error/mesh_evaluation.hpp"

namespace fusebench::metric_reports {

/// What was compared, as it was named, and how.
struct ComparedMeshes {
  std::string reconstruction;
  std::string truth;
  double scale = 1;       ///< of the reconstruction's numbers, to metres
  std::string recording;  ///< of the views that culled the ground truth; empty: not culled
};

/// Both meshes, alignment, samples and culling, then statistics of both directions, the scores at the
/// thresholds, Chamfer distance and SurfReg's score.
[[nodiscard]] std::string to_text(const mesh_error::MeshEvaluation& evaluation,
                                  const mesh_error::MeshRequest& request, const ComparedMeshes& files);

/// {"metric": "mesh", "unit": "m", "reconstruction", "truth", "alignment": {"mode", "matrix"}, "samples",
/// "culling", "accuracy": {statistics, "p90", "p95"}, "completeness", "surfreg_m", "surfreg_icp_m",
/// "chamfer_m", "thresholds": [{"tau_m", "precision", "recall", "fscore"}]}; with culling also "not_culled",
/// after a registration "icp", whose "doubt" is null or says why it may have found another place. Ends with a
/// newline.
[[nodiscard]] std::string to_json(const mesh_error::MeshEvaluation& evaluation,
                                  const mesh_error::MeshRequest& request, const ComparedMeshes& files);

}  // namespace fusebench::metric_reports
