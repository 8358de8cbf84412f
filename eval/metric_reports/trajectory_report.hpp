// The evaluation of a trajectory, for people and for programs.
#pragma once

#include <string>

#include "eval/trajectory_error/trajectory_evaluation.hpp"
#include "eval/trajectory_files/trajectory_formats.hpp"

namespace fusebench::metric_reports {

/// Where the two sides came from.
struct ComparedFiles {
  std::string reference;
  trajectory_files::TrajectoryFormat reference_format = trajectory_files::TrajectoryFormat::tum;
  std::string estimate;
  trajectory_files::TrajectoryFormat estimate_format = trajectory_files::TrajectoryFormat::tum;
};

/// The protocol and all that the numbers depend on, then the statistics; segments as a table.
[[nodiscard]] std::string to_text(const trajectory_error::TrajectoryEvaluation& evaluation,
                                  const ComparedFiles& files);

enum class EachError { left_out, listed };

/// {"metric", "protocol", "relation", "unit", "pairs", "possible", "coverage", "association", "alignment":
/// {"mode", "first", "scale", "matrix"}, "stats"} of the first series, the other series as "also", segments
/// as "segments", and of motions "motions". Listed, each error of a series is in "errors", and its stamp,
/// integer nanoseconds, in "timestamps_ns". Ends with a newline.
[[nodiscard]] std::string to_json(const trajectory_error::TrajectoryEvaluation& evaluation,
                                  const ComparedFiles& files, EachError each);

}  // namespace fusebench::metric_reports
