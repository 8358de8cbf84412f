#include "eval/report/metric_reports/trajectory_listing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/metrics/reference_clock/clock_json.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/metrics/trajectory_error/motion_pairs.hpp"
#include "eval/metrics/trajectory_files/stamps.hpp"
#include "eval/report/metric_reports/clock_report.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::metric_reports {

namespace {

using NamedNumbers = std::vector<std::pair<std::string, double>>;

double path_m(const Trajectory& poses) { return trajectory_error::path_lengths(poses).back(); }
double start_s(const Trajectory& poses) {
  return trajectory_files::stamp_seconds(poses.front().timestamp_ns);
}
double end_s(const Trajectory& poses) { return trajectory_files::stamp_seconds(poses.back().timestamp_ns); }
double duration_s(const Trajectory& poses) {
  return seconds_between(poses.front().timestamp_ns, poses.back().timestamp_ns);
}

NamedNumbers infos(const ListedTrajectory& trajectory) {
  const Trajectory& poses = trajectory.poses;
  NamedNumbers numbers = {{"nr. of poses", static_cast<double>(poses.size())},
                          {"path length (m)", path_m(poses)}};
  if (!trajectory.has_stamps) return numbers;
  numbers.emplace_back("duration (s)", duration_s(poses));
  numbers.emplace_back("t_start (s)", start_s(poses));
  numbers.emplace_back("t_end (s)", end_s(poses));
  return numbers;
}

/// The first pose whose stamp is not later than the one before it.
std::optional<std::size_t> not_ascending(const Trajectory& poses) {
  const auto found = std::ranges::adjacent_find(
      poses, [](const StampedPose& a, const StampedPose& b) { return a.timestamp_ns >= b.timestamp_ns; });
  if (found == poses.end()) return std::nullopt;
  return static_cast<std::size_t>(found - poses.begin()) + 1;
}

/// Speeds and intervals from pose to pose; none where stamps do not ascend.
NamedNumbers speeds(const ListedTrajectory& trajectory) {
  const Trajectory& poses = trajectory.poses;
  if (!trajectory.has_stamps || poses.size() < 2 || not_ascending(poses)) return {};
  std::vector<double> intervals_s;
  std::vector<double> speeds_mps;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    intervals_s.push_back(seconds_between(poses[i - 1].timestamp_ns, poses[i].timestamp_ns));
    const double step_m =
        (poses[i].T_world_camera.translation - poses[i - 1].T_world_camera.translation).norm();
    speeds_mps.push_back(step_m / intervals_s.back());
  }
  const metrics::Statistics speed = metrics::statistics(speeds_mps);
  const metrics::Statistics interval = metrics::statistics(intervals_s);
  constexpr double kKilometresPerHour = 3.6;
  return {{"v_max (m/s)", speed.max},
          {"v_min (m/s)", speed.min},
          {"v_avg (m/s)", speed.mean},
          {"v_max (km/h)", kKilometresPerHour * speed.max},
          {"v_min (km/h)", kKilometresPerHour * speed.min},
          {"v_avg (km/h)", kKilometresPerHour * speed.mean},
          {"dt_max (s)", interval.max},
          {"dt_min (s)", interval.min},
          {"dt_avg (s)", interval.mean}};
}

std::string vector_text(const Vector3d& v) {
  return fmt::format("[{:.8g} {:.8g} {:.8g}]", v.x(), v.y(), v.z());
}

std::string line_of(const ListedTrajectory& trajectory) {
  const Trajectory& poses = trajectory.poses;
  std::string line = fmt::format("{} poses, {:.3f}m path length", poses.size(), path_m(poses));
  if (trajectory.has_stamps) line += fmt::format(", {:.3f}s duration", duration_s(poses));
  return "infos:\t" + line + "\n";
}

/// Sorted by name, as evo prints a dictionary.
std::string block(const std::string& name, std::vector<std::pair<std::string, std::string>> entries) {
  std::ranges::sort(entries);
  std::string text = name + ":";
  for (const auto& [key, value] : entries) text += fmt::format("\n\t{}\t{}", key, value);
  return text + "\n";
}

std::string infos_block(const ListedTrajectory& trajectory) {
  std::vector<std::pair<std::string, std::string>> entries;
  for (const auto& [name, value] : infos(trajectory)) entries.emplace_back(name, fmt::format("{}", value));
  if (trajectory.has_stamps) {
    std::erase_if(entries, [](const auto& entry) { return entry.first.starts_with("t_"); });
    entries.emplace_back("t_start (s)", trajectory::stamp_text(trajectory.poses.front().timestamp_ns));
    entries.emplace_back("t_end (s)", trajectory::stamp_text(trajectory.poses.back().timestamp_ns));
  }
  entries.emplace_back("pos_start (m)", vector_text(trajectory.poses.front().T_world_camera.translation));
  entries.emplace_back("pos_end (m)", vector_text(trajectory.poses.back().T_world_camera.translation));
  return block("infos", std::move(entries));
}

std::string checks_block(const ListedTrajectory& trajectory) {
  std::vector<std::pair<std::string, std::string>> checks;
  if (trajectory.has_stamps) {
    const auto wrong = not_ascending(trajectory.poses);
    checks.emplace_back(
        "timestamps", wrong ? fmt::format("wrong, pose {} is not later than the one before", *wrong) : "ok");
  }
  if (trajectory.remarks.empty()) checks.emplace_back("rows", "ok");
  for (const std::string& remark : trajectory.remarks) checks.emplace_back("rows", remark);
  std::vector<std::pair<std::string, std::string>> stats;
  for (const auto& [name, value] : speeds(trajectory)) stats.emplace_back(name, fmt::format("{:.6f}", value));
  if (trajectory.has_stamps && stats.empty())
    stats.emplace_back("error", "stamps that ascend are needed for speeds");
  return block("checks", std::move(checks)) + block("stats", std::move(stats));
}

/// "formats: a tum (by its columns), b euroc (names in line 1)"; without names if all have the same.
std::string formats_line_of(const std::vector<ListedTrajectory>& trajectories) {
  const auto format_of = [](const ListedTrajectory& trajectory) {
    return fmt::format("{} ({})", trajectory.format, trajectory.format_source);
  };
  const auto differs = [&](const ListedTrajectory& trajectory) {
    return format_of(trajectory) != format_of(trajectories.front());
  };
  if (std::ranges::none_of(trajectories, differs))
    return fmt::format("formats: {}\n", format_of(trajectories.front()));
  std::string line;
  for (const ListedTrajectory& trajectory : trajectories)
    line += fmt::format("{} {} {}", line.empty() ? "formats:" : ",", trajectory.name, format_of(trajectory));
  return line + "\n";
}

}  // namespace

std::string to_text(const std::vector<ListedTrajectory>& trajectories, ListingDetail detail) {
  std::string text = formats_line_of(trajectories);
  for (const ListedTrajectory& trajectory : trajectories) {
    text += fmt::format("{:-<80}\nname:\t{}\n", "", trajectory.name);
    text += detail == ListingDetail::line ? line_of(trajectory) : infos_block(trajectory);
    if (detail == ListingDetail::checks) text += checks_block(trajectory);
    if (trajectory.clock) text += clock_text(*trajectory.clock);
  }
  return text;
}

std::string to_csv(const std::vector<ListedTrajectory>& trajectories) {
  std::string csv;
  for (const ListedTrajectory& trajectory : trajectories) csv += "," + text::csv_cell(trajectory.name);
  csv += '\n';
  std::vector<NamedNumbers> columns;
  std::vector<std::string> names;
  for (const ListedTrajectory& trajectory : trajectories) {
    NamedNumbers numbers = infos(trajectory);
    for (auto& number : speeds(trajectory)) numbers.push_back(std::move(number));
    for (const auto& [name, value] : numbers) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
    columns.push_back(std::move(numbers));
  }
  for (const std::string& name : names) {
    csv += text::csv_cell(name);
    for (const NamedNumbers& column : columns) {
      const auto found = std::ranges::find(column, name, [](const auto& entry) { return entry.first; });
      csv += found == column.end() ? "," : fmt::format(",{}", found->second);
    }
    csv += '\n';
  }
  return csv;
}

std::string to_json(const std::vector<ListedTrajectory>& trajectories) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ListedTrajectory& trajectory : trajectories) {
    const Trajectory& poses = trajectory.poses;
    const Vector3d& first = poses.front().T_world_camera.translation;
    const Vector3d& last = poses.back().T_world_camera.translation;
    nlohmann::ordered_json row = {{"name", trajectory.name},
                                  {"format", trajectory.format},
                                  {"format_source", trajectory.format_source},
                                  {"poses", poses.size()},
                                  {"path_m", path_m(poses)},
                                  {"duration_s", nullptr},
                                  {"start_ns", nullptr},
                                  {"end_ns", nullptr},
                                  {"first_m", {first.x(), first.y(), first.z()}},
                                  {"last_m", {last.x(), last.y(), last.z()}}};
    if (trajectory.has_stamps) {
      row["duration_s"] = duration_s(poses);
      row["start_ns"] = poses.front().timestamp_ns;
      row["end_ns"] = poses.back().timestamp_ns;
    }
    if (trajectory.clock) row["reference_clock"] = reference_clock::json_of(*trajectory.clock);
    rows.push_back(std::move(row));
  }
  return text::json_text(rows) + "\n";
}

}  // namespace fusebench::metric_reports
