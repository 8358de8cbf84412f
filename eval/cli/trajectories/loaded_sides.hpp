// A reference and an estimate, as the verbs that compare two trajectories load them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "eval/metrics/trajectory_files/trajectory_pair.hpp"
#include "eval/report/metric_reports/trajectory_report.hpp"

namespace fusebench::cli::trajectories {

struct Sides {
  trajectory_files::LoadedTrajectory reference;
  trajectory_files::LoadedTrajectory estimate;
  [[nodiscard]] bool have_stamps() const { return reference.has_stamps() && estimate.has_stamps(); }
  [[nodiscard]] trajectory_files::AssociationRule rule_without_stamps() const {
    return reference.has_numbers() || estimate.has_numbers() ? trajectory_files::AssociationRule::number
                                                             : trajectory_files::AssociationRule::index;
  }
};

/// Reading options of the two files; formats that are not given are recognised.
struct SideReadings {
  trajectory_files::TrajectoryReading reference = {};
  trajectory_files::TrajectoryReading estimate = {};
};

/// Sets the unit of stamps: "ns" of both files, but of those that cannot count so; "s,ns" of the reference
/// and of the estimate. Nothing if the text is empty. Error usage for another name or more than two.
[[nodiscard]] Result<void> set_stamp_units(const std::string& units, SideReadings& readings);
inline constexpr const char* kStampUnitHelp =
    "Unit of stamps: s, ms, us or ns, unless column names in the file contain it. Files with more decimals "
    "than the unit has stay in seconds; REF,EST sets each side. Default: by their size if since 1970";

/// For reports.
[[nodiscard]] metric_reports::ComparedFiles compared_files(const std::string& reference,
                                                           const std::string& estimate, const Sides& sides);

/// Reads both. Errors: those of load_trajectory().
[[nodiscard]] Result<Sides> load_sides(const std::filesystem::path& reference,
                                       const std::filesystem::path& estimate, const SideReadings& readings,
                                       std::vector<std::string>& warnings);

/// Reads both and prints the warnings.
[[nodiscard]] Result<Sides> load_sides(const std::filesystem::path& reference,
                                       const std::filesystem::path& estimate);

}  // namespace fusebench::cli::trajectories
