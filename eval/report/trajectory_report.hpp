// The evaluation of a trajectory, for people and for programs.
#pragma once

#include <string>

#include "eval/trajectory/evaluation.hpp"
#include "eval/trajectory/trajectory_formats.hpp"

namespace fusebench {

/// Where the two sides came from.
struct ComparedFiles {
  std::string reference;
  TrajectoryFormat reference_format = TrajectoryFormat::tum;
  std::string estimate;
  TrajectoryFormat estimate_format = TrajectoryFormat::tum;
};

/// The protocol and all that the numbers depend on, then the statistics; segments as a table.
[[nodiscard]] std::string to_text(const TrajectoryEvaluation& evaluation, const ComparedFiles& files);

/// {"metric", "protocol", "relation", "unit", "pairs", "possible", "coverage", "association", "alignment":
/// {"mode", "first", "scale", "matrix"}, "errors", "stats"} of the first series, the other series as "also",
/// segments as "segments", and of motions "motions". Stamps in integer nanoseconds. Ends with a newline.
[[nodiscard]] std::string to_json(const TrajectoryEvaluation& evaluation, const ComparedFiles& files);

}  // namespace fusebench
