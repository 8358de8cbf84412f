// From the options of `fusebench eval ate` and `rpe` to what is to be evaluated.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/trajectory/trajectory_file.hpp"
#include "eval/cli/evaluation/loaded_sides.hpp"
#include "eval/trajectory_error/trajectory_evaluation.hpp"
#include "eval/trajectory_files/trajectory_formats.hpp"

namespace fusebench::cli::evaluation {

/// What the command line says, by the names of its options.
struct TrajectoryOptions {
  std::vector<std::string> files;  ///< reference and estimate; before them, as evo has it, perhaps a format
  std::string format;
  std::string protocol = "evo";
  std::string align;
  bool evo_align = false;
  bool evo_scale = false;
  bool evo_origin = false;
  std::size_t n_to_align = 0;
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
  bool verbose = false;
  std::filesystem::path errors;
  bool json = false;
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
inline constexpr std::array<std::pair<const char*, trajectory_error::AlignmentMode>, 6> kAlignments{
    {{"none", trajectory_error::AlignmentMode::none},
     {"se3", trajectory_error::AlignmentMode::se3},
     {"sim3", trajectory_error::AlignmentMode::sim3},
     {"scale", trajectory_error::AlignmentMode::scale},
     {"yaw", trajectory_error::AlignmentMode::yaw},
     {"origin", trajectory_error::AlignmentMode::origin}}};

/// The value of a name that the parser has let through.
template <typename T, std::size_t N>
T named(const std::array<std::pair<const char*, T>, N>& names, const std::string& name) {
  for (const auto& [known, value] : names) {
    if (name == known) return value;
  }
  return names.front().second;  // the parser lets no other name through
}

/// Takes a format that stands before the files. Error usage if it is given twice.
[[nodiscard]] Result<void> take_leading_format(TrajectoryOptions& options);

/// The protocol's request, with what the options change. Error usage for options that do not go together;
/// errors of read_stamps() for --images.
[[nodiscard]] Result<trajectory_error::TrajectoryRequest> request_of(
    const TrajectoryOptions& options, trajectory_error::TrajectoryMetric metric);

/// Poses without stamps are associated by their index, whatever the protocol does otherwise. Error usage if
/// that is not possible.
[[nodiscard]] Result<void> suit_stamps(const Sides& sides, trajectory_error::TrajectoryRequest& request);

}  // namespace fusebench::cli::evaluation
