// What evo keeps of one evaluation (v1.36.5: evo/core/result.py, evo/main_ape.py, evo/main_rpe.py).
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/types.hpp"
#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"
#include "eval/report/evo_results/npy_array.hpp"

namespace fusebench::evo_results {

struct NamedTrajectory {
  std::string name;  ///< the file that it came from
  Trajectory poses;
  bool has_stamps = true;  ///< kept as TUM text, else as KITTI's
};

/// Names are evo's.
struct EvoResult {
  std::string title;           ///< "APE w.r.t. translation part (m)\n(not aligned)"
  std::string reference_name;  ///< the file
  std::string estimate_name;
  std::string label;                                  ///< of an axis: "APE (m)"
  std::vector<std::pair<std::string, double>> stats;  ///< rmse, mean, median, std, min, max, sse
  /// error_array; with stamps also seconds_from_start, timestamps, distances_from_start (of the reference)
  /// and distances (of the estimate); alignment_transformation_sim3, 4x4, if there was one.
  std::vector<std::pair<std::string, NpyArray>> arrays;
  std::vector<NamedTrajectory> trajectories;  ///< as compared: associated, aligned, projected

  /// Null if there is none.
  [[nodiscard]] const NpyArray* array(std::string_view name) const;
};

/// The two sides of an evaluation.
struct EvaluatedFiles {
  std::string reference;
  std::string estimate;
  bool have_stamps = true;
};

/// What evo keeps of the first series of an evaluation, whose errors are listed and whose poses are kept. Of
/// motions, poses and arrays are those of the motions' ends, and the first pose. Of protocols that select
/// motions otherwise than evo, poses are left as they were compared, and there are no distances.
[[nodiscard]] EvoResult result_of(const trajectory_error::TrajectoryEvaluation& evaluation,
                                  const EvaluatedFiles& files);

}  // namespace fusebench::evo_results
