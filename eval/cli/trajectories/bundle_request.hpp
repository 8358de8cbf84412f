// From the options of `fusebench eval traj` to trajectories, in evo's order of operations.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/cli/trajectories/alignment_options.hpp"
#include "eval/cli/trajectories/plot_options.hpp"
#include "eval/cli/trajectories/transcript.hpp"
#include "eval/report/metric_reports/trajectory_listing.hpp"

namespace fusebench::cli::trajectories {

/// The options as given, by their names.
struct BundleOptions {
  std::vector<std::string> files;
  std::string format;
  std::string stamp_unit;
  std::string reference;
  AlignmentOptions alignment;
  bool sync = false;
  double t_offset = 0;
  bool fit_time_offset = false;
  double t_max_diff = 0.01;
  std::size_t downsample = 0;
  std::vector<double> motion_filter;
  std::string plane = "none";
  bool full_check = false;
  bool full_names = false;
  PlotOptions plot;
  std::string plot_mode = "xyz";
  bool relative_time = false;  ///< accepted, and of no effect
  std::filesystem::path save_table;
  bool save_as_tum = false;
  bool save_as_kitti = false;
  TranscriptOptions transcript;
  bool json = false;
};

struct NamedFile {
  std::string file;
  metric_reports::ListedTrajectory trajectory;
};

/// The trajectories in the order of the command line, the reference last.
struct Bundle {
  std::vector<NamedFile> trajectories;
  bool has_reference = false;
  bool has_stamps = true;
};

/// Reads the files, downsamples, filters, moves stamps (by the fitted offset of the reference's clock as
/// well, where it is requested), associates each with the reference (--sync, or to be aligned), aligns and
/// projects. Errors: usage for options that do not go together, and files with and without stamps; those of
/// load_trajectory(), fitted_time_offset(), pair_up() and align().
[[nodiscard]] Result<Bundle> bundle_of(const BundleOptions& options, Transcript& transcript);

/// Writes NAME.tum or NAME.kitti of each into the current folder, as evo_traj --save_as_tum and
/// --save_as_kitti. Errors: usage where two would be one file, a file would replace its own source, or stamps
/// are missing (tum); io.
[[nodiscard]] Result<void> save_bundle(const BundleOptions& options, const Bundle& bundle,
                                       Transcript& transcript);

}  // namespace fusebench::cli::trajectories
