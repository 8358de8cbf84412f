// The evaluation of a trajectory, for people and for programs.
#pragma once

#include <optional>
#include <string>

#include "eval/metrics/reference_clock/clocked_errors.hpp"
#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"

namespace fusebench::metric_reports {

/// Where the two sides came from.
struct ComparedFiles {
  std::string reference;
  trajectory_files::TrajectoryFormat reference_format = trajectory_files::TrajectoryFormat::tum;
  std::string estimate;
  trajectory_files::TrajectoryFormat estimate_format = trajectory_files::TrajectoryFormat::tum;
  std::string reference_format_source = {};  ///< see LoadedTrajectory::format_source
  std::string estimate_format_source = {};
};

/// "formats: reference tum (by its columns), estimate euroc (names in line 1)", with a line feed.
[[nodiscard]] std::string formats_line(const ComparedFiles& files);

/// The formats, the protocol and all that the numbers depend on, then the statistics; segments as a table.
/// Ends with the clock of the reference where it was fitted.
[[nodiscard]] std::string to_text(const trajectory_error::TrajectoryEvaluation& evaluation,
                                  const ComparedFiles& files,
                                  const std::optional<reference_clock::ReferenceClock>& clock = std::nullopt);

enum class EachError { left_out, listed };

/// {"metric", "protocol", "relation", "unit", "pairs", "possible", "coverage", "association", "alignment":
/// {"mode", "first", "scale", "matrix"}, "stats"} of the first series, the other series as "also", segments
/// as "segments", and of motions "motions". Listed, each error of a series is in "errors", and its stamp,
/// integer nanoseconds, in "timestamps_ns"; "reference_clock" where it was fitted. Ends with a newline.
[[nodiscard]] std::string to_json(const trajectory_error::TrajectoryEvaluation& evaluation,
                                  const ComparedFiles& files, EachError each,
                                  const std::optional<reference_clock::ReferenceClock>& clock = std::nullopt);

}  // namespace fusebench::metric_reports
