#include "eval/report/metric_reports/trajectories_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "core/base/geometry.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/metrics/trajectory_error/euler_angles.hpp"

namespace fusebench::metric_reports {

namespace {

/// Time since the first pose of all, or the number of the pose.
struct TimeAxis {
  bool stamps = true;
  std::int64_t start_ns = 0;
  std::string label;
  [[nodiscard]] double at(const Trajectory& poses, std::size_t i) const {
    return stamps ? seconds_between(start_ns, poses[i].timestamp_ns) : static_cast<double>(i);
  }
};

TimeAxis time_axis(const TrajectoriesPlot& plot) {
  if (!plot.has_stamps) return {false, 0, "pose"};
  std::int64_t start_ns = std::numeric_limits<std::int64_t>::max();
  for (const DrawnTrajectory& drawn : plot.trajectories)
    for (const StampedPose& pose : drawn.poses) start_ns = std::min(start_ns, pose.timestamp_ns);
  return {true, start_ns, fmt::format("time since {} s [s]", trajectory::stamp_text(start_ns))};
}

std::string style_of(const TrajectoriesPlot& plot, std::size_t i) {
  if (plot.trajectories[i].reference) return std::string(kReferenceStyle);
  return fmt::format("lw 1.5 lc rgb '{}'", page::figure_colour(i));
}

/// One number of each pose of all trajectories over time; an angle that passes half a turn is a gap.
std::string over_time_panel(const TrajectoriesPlot& plot, const TimeAxis& time, int component) {
  constexpr std::array<const char*, 6> kNames = {"x [m]",      "y [m]",       "z [m]",
                                                 "roll [deg]", "pitch [deg]", "yaw [deg]"};
  const auto value = [&](const StampedPose& pose) {
    if (component < 3) return pose.T_world_camera.translation[component];
    return degrees(
        trajectory_error::roll_pitch_yaw_rad(pose.T_world_camera.rotation_matrix())[component - 3]);
  };
  std::string script;
  for (std::size_t k = 0; k < plot.trajectories.size(); ++k) {
    const Trajectory& poses = plot.trajectories[k].poses;
    script += fmt::format("$over_time_{}_{} << END\n", component, k);
    double last = 0;
    for (const std::size_t i : strided(poses.size())) {
      const double y = value(poses[i]);
      if (component >= 3 && i > 0 && std::abs(y - last) > 180) script += '\n';
      fmt::format_to(std::back_inserter(script), "{:.8g} {:.7g}\n", time.at(poses, i), y);
      last = y;
    }
    script += "END\n";
  }
  const int row = component % 3;
  script += placed({component < 3 ? 0.0 : 0.5, 0.01 + 0.16 * (2 - row), 0.5, row == 2 ? 0.17 : 0.16});
  script += fmt::format("set lmargin 9\nset rmargin 2\nset xlabel {}\nset ylabel {}\nunset key\nplot ",
                        row == 2 ? page::gnuplot_text(time.label) : "''",
                        page::gnuplot_text(kNames[static_cast<std::size_t>(component)]));
  for (std::size_t k = 0; k < plot.trajectories.size(); ++k)
    script +=
        fmt::format("{}$over_time_{}_{} with lines {}", k > 0 ? ", " : "", component, k, style_of(plot, k));
  return script + "\n";
}

}  // namespace

std::string plot_script(const TrajectoriesPlot& plot, const PlotFile& file) {
  std::string script = plot_begin(file, 1100, 1300);
  std::vector<const Trajectory*> drawn;
  std::string curves;
  for (std::size_t i = 0; i < plot.trajectories.size(); ++i) {
    drawn.push_back(&plot.trajectories[i].poses);
    script += position_block(fmt::format("view{}", i), plot.trajectories[i].poses, plot.mode);
    curves +=
        fmt::format("{}$view{} using {} with lines {} title {}", i > 0 ? ", " : "", i, plot.mode.columns(),
                    style_of(plot, i), page::gnuplot_text(plot.trajectories[i].label));
  }
  script += placed({0, 0.5, 1, 0.49}) + view_axes(plot.mode, drawn, 1.45);
  script += fmt::format("set key {} Left reverse samplen 2.5\n",
                        plot.mode.plane() ? "outside right center" : "at screen 0.97,0.97 right top");
  script += std::string(plot.mode.command()) + curves + "\n";
  script += kNextPanel;
  const TimeAxis time = time_axis(plot);
  for (int component = 0; component < 6; ++component) script += over_time_panel(plot, time, component);
  return script + std::string(kPlotEnd);
}

}  // namespace fusebench::metric_reports
