// The request of `fusebench eval ate` and `rpe` from their options.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/trajectory/trajectory_rows.hpp"
#include "eval/cli/trajectories/alignment_options.hpp"
#include "eval/cli/trajectories/loaded_sides.hpp"
#include "eval/cli/trajectories/plot_options.hpp"
#include "eval/cli/trajectories/transcript.hpp"
#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "eval/report/metric_reports/error_plot.hpp"

namespace fusebench::cli::trajectories {

/// How an evaluation is drawn.
struct ErrorPlotOptions {
  std::string mode = "xyz";
  std::string abscissa = "seconds";
  std::optional<double> colour_min;
  std::optional<double> colour_max;
  std::optional<double> colour_max_percentile;
  bool full_reference = false;
};

/// The options as given, by their names.
struct TrajectoryOptions {
  std::vector<std::string> files;  ///< reference and estimate; before them, as evo has it, perhaps a format
  std::string format;
  std::string stamp_unit;
  std::string protocol = "evo";
  AlignmentOptions alignment;
  std::optional<double> t_max_diff;
  double t_offset = 0;
  std::optional<double> t_start;
  std::optional<double> t_end;
  bool interpolate = false;
  std::filesystem::path images;
  std::string duplicates;
  std::size_t downsample = 0;
  std::vector<double> motion_filter;
  std::string plane = "none";
  std::string relation = "trans_part";
  std::string change_unit;
  std::optional<double> delta;
  std::string delta_unit;
  double delta_tol = 0.1;
  bool all_pairs = false;
  bool pairs_from_reference = false;
  bool fit_offset = false;
  bool fit_time_offset = false;
  std::filesystem::path errors;
  std::filesystem::path save_results;
  PlotOptions plot;
  ErrorPlotOptions error_plot;
  TranscriptOptions transcript;
  bool json = false;
  bool all_errors = false;  ///< in the JSON text
};

inline constexpr std::array<std::pair<const char*, trajectory::Duplicates>, 4> kDuplicates{
    {{"error", trajectory::Duplicates::none},
     {"first", trajectory::Duplicates::first},
     {"last", trajectory::Duplicates::last},
     {"keep", trajectory::Duplicates::as_written}}};
inline constexpr std::array<std::pair<const char*, trajectory_error::Plane>, 4> kPlanes{
    {{"none", trajectory_error::Plane::none},
     {"xy", trajectory_error::Plane::xy},
     {"xz", trajectory_error::Plane::xz},
     {"yz", trajectory_error::Plane::yz}}};
inline constexpr std::array<std::pair<const char*, metric_reports::PlotAbscissa>, 3> kAbscissae{
    {{"seconds", metric_reports::PlotAbscissa::seconds},
     {"index", metric_reports::PlotAbscissa::index},
     {"distances", metric_reports::PlotAbscissa::distances}}};

/// Removes a format before the files; two files must remain. Errors: usage for another number, and those
/// of take_leading_format().
[[nodiscard]] Result<void> take_two_files(TrajectoryOptions& options);

/// The protocol's request with the changes by the options. Error usage for options that do not go together;
/// errors and warnings of read_stamps() for --images.
[[nodiscard]] Result<trajectory_error::TrajectoryRequest> request_of(
    const TrajectoryOptions& options, trajectory_error::TrajectoryMetric metric,
    std::vector<std::string>& warnings);

/// Associates poses without stamps by their index, for any protocol. Error usage if that is not possible.
[[nodiscard]] Result<void> suit_stamps(const Sides& sides, trajectory_error::TrajectoryRequest& request);

}  // namespace fusebench::cli::trajectories
