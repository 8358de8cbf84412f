// What trajectories are, in numbers, as evo_traj lists them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "eval/metrics/reference_clock/clocked_errors.hpp"

namespace fusebench::metric_reports {

struct ListedTrajectory {
  std::string name;
  Trajectory poses;
  bool has_stamps = true;
  std::string format = {};                ///< "tum"
  std::string format_source = {};         ///< "by its columns"
  std::vector<std::string> remarks = {};  ///< of the reader
  /// Of the reference against this one, where it was fitted.
  std::optional<reference_clock::ReferenceClock> clock = {};
};

enum class ListingDetail {
  line,    ///< poses, path and duration on a line
  infos,   ///< and the ends (evo_traj -v)
  checks,  ///< and checks of the file, speeds and intervals (evo_traj --full_check)
};

/// A line of formats, then evo's layout: a rule, "name:", "infos:"; then the clock where it was fitted.
[[nodiscard]] std::string to_text(const std::vector<ListedTrajectory>& trajectories, ListingDetail detail);
/// As evo_traj --save_table: a column for each trajectory; lines are poses, path, duration, ends in time,
/// speeds and intervals. Numbers with their shortest round trip.
[[nodiscard]] std::string to_csv(const std::vector<ListedTrajectory>& trajectories);
/// [{"name", "format", "format_source", "poses", "path_m", "duration_s", "start_ns", "end_ns", "first_m",
/// "last_m"}]; times null without stamps, and "reference_clock" where it was fitted.
[[nodiscard]] std::string to_json(const std::vector<ListedTrajectory>& trajectories);

}  // namespace fusebench::metric_reports
