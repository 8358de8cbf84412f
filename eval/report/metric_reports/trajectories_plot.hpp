// A picture of any number of trajectories, as evo_traj draws it.
#pragma once

#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "eval/report/metric_reports/plot_parts.hpp"

namespace fusebench::metric_reports {

struct DrawnTrajectory {
  std::string label;
  Trajectory poses;
  bool reference = false;
};

struct TrajectoriesPlot {
  std::vector<DrawnTrajectory> trajectories;
  PlotMode mode;
  bool has_stamps = true;
};

/// The trajectories in one view; x, y, z, roll, pitch and yaw over time.
[[nodiscard]] std::string plot_script(const TrajectoriesPlot& plot, const PlotFile& file);

}  // namespace fusebench::metric_reports
