#include "eval/trajectory_files/format_recognition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/printable.hpp"
#include "core/io/row_text.hpp"
#include "core/io/stamp_unit.hpp"

namespace fusebench::trajectory_files {

namespace {

using trajectory::HeadRow;
using trajectory::PoseHead;
using trajectory::PoseLayout;

constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
constexpr std::size_t kWholePoseColumns = 16;  // kitti with the last row of each matrix
constexpr std::size_t kEurocColumns = 17;
constexpr std::size_t kLogHeader = 3;
constexpr std::size_t kOpenvinsColumns = 20;

constexpr std::string_view kEurocNames = "timestamp px py pz qw qx qy qz ...";
constexpr std::string_view kOpenvinsNames =
    "timestamp tx ty tz qx qy qz qw Pr11 Pr12 Pr13 Pr22 Pr23 Pr33 Pt11 Pt12 Pt13 Pt22 Pt23 Pt33";

double number_in(const HeadRow& row, std::size_t column) {
  return io::parse_number(row.fields[column]).value_or(std::nan(""));
}

double norm_of(const HeadRow& row, std::size_t first, std::size_t count) {
  double sum = 0;
  for (std::size_t i = first; i < first + count; ++i) sum += number_in(row, i) * number_in(row, i);
  return std::sqrt(sum);
}

bool is_one(double norm) {
  constexpr double kTolerance = 1e-2;
  return std::abs(norm - 1) < kTolerance;
}

/// Stamps and unit quaternions, or rows of lost frames.
bool could_be_tum(const PoseHead& head) {
  return std::ranges::all_of(head.rows, [](const HeadRow& row) {
    if (row.fields.size() < kTumColumns || std::isnan(number_in(row, 0))) return false;
    const bool nan = std::any_of(row.fields.begin() + 1, row.fields.begin() + kTumColumns, io::is_nan);
    const double norm = norm_of(row, 4, 4);
    return nan || norm == 0 || is_one(norm);
  });
}

/// Integers of nanoseconds with commas between the columns.
bool is_euroc(const PoseHead& head) {
  constexpr std::size_t kNanosecondDigits = 14;  // a day; seconds have not that many
  const std::string& stamp = head.rows.front().fields.front();
  return head.commas() && stamp.size() >= kNanosecondDigits &&
         stamp.find_first_not_of("0123456789") == std::string::npos;
}

/// Rows of 3x4 poses from column `first` on.
bool has_rotations(const PoseHead& head, std::size_t first) {
  return std::ranges::all_of(head.rows, [first](const HeadRow& row) {
    return row.fields.size() >= first + kKittiColumns && is_one(norm_of(row, first, 3)) &&
           is_one(norm_of(row, first + 4, 3)) && is_one(norm_of(row, first + 8, 3));
  });
}

/// Entries of rotations are within -1 and 1, and stamps soon are not.
bool has_stamps(const PoseHead& head) {
  constexpr double kMoreThanAnEntry = 2;
  return std::ranges::any_of(head.rows,
                             [](const HeadRow& row) { return number_in(row, 0) > kMoreThanAnEntry; });
}

bool ends_with_last_row(const HeadRow& row) {
  return row.fields.size() == kWholePoseColumns && number_in(row, 12) == 0 && number_in(row, 13) == 0 &&
         number_in(row, 14) == 0 && number_in(row, 15) == 1;
}

Result<TrajectoryFormat> format_by_columns(const PoseHead& head, const std::filesystem::path& file) {
  const std::size_t columns = head.columns();
  if (columns == kLogHeader) return TrajectoryFormat::log;
  if (columns >= kTumColumns && is_euroc(head)) return TrajectoryFormat::euroc;
  if (columns == kTumColumns) return TrajectoryFormat::tum;
  if (columns == kOpenvinsColumns) return TrajectoryFormat::openvins;
  if (columns == kEurocColumns && head.commas()) return TrajectoryFormat::euroc;
  if (columns == kWholePoseColumns && ends_with_last_row(head.rows.front())) return TrajectoryFormat::kitti;
  // A stamp and the matrix of a pose are no quaternion with more columns.
  const bool other_tum = columns > kTumColumns && could_be_tum(head) && !has_rotations(head, 1);
  if (columns == kKittiColumns)
    return other_tum && has_stamps(head) && !has_rotations(head, 0) ? TrajectoryFormat::tum
                                                                    : TrajectoryFormat::kitti;
  if (other_tum) return TrajectoryFormat::tum;
  const bool semicolons = head.rows.front().fields.front().find(';') != std::string::npos;
  const std::string hint = semicolons ? "replace the semicolons between the numbers by commas or blanks"
                           : columns > kTumColumns
                               ? "a line of names before the rows says which columns are which, for instance "
                                 "# timestamp tx ty tz qx qy qz qw; `--format` names the format"
                               : "`--format` names the format if the first row does not";
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("{}:{}: {} columns are no trajectory (tum has 8 or more, kitti 12 or 16, euroc 8 or "
                  "more, log 3, openvins 20)",
                  file.string(), head.rows.front().line, columns),
      hint);
}

bool names_covariances(const PoseHead& head) {
  if (head.names.size() <= kTumColumns) return true;  // the rest has no names
  const std::string& ninth = head.names[kTumColumns];
  return ninth.starts_with('P') || ninth.starts_with('p') || ninth.starts_with("cov");
}

PoseLayout layout_for(TrajectoryFormat format, std::size_t columns) {
  PoseLayout layout;
  if (format == TrajectoryFormat::euroc) {
    layout.columns = trajectory::kEurocColumns;
    layout.names = kEurocNames;
    if (columns == kEurocColumns) layout.explained = kEurocColumns;  // velocity and biases
  } else if (format == TrajectoryFormat::openvins) {
    layout.names = kOpenvinsNames;
    layout.explained = kOpenvinsColumns;
  }
  return layout;
}

RecognisedFormat without_names(TrajectoryFormat format, std::string source, const PoseHead& head) {
  return {format, std::move(source), layout_for(format, head.columns()), format == TrajectoryFormat::euroc};
}

/// Covariances have no place in the names of a pose: their columns are those of the format.
bool is_named_openvins(const PoseHead& head, const TrajectoryReading& reading) {
  if (!head.named->columns.same_places(trajectory::kTumColumns)) return false;
  if (reading.format) return *reading.format == TrajectoryFormat::openvins;
  return head.columns() == kOpenvinsColumns && !head.commas() && names_covariances(head);
}

RecognisedFormat by_names(const PoseHead& head, const TrajectoryReading& reading,
                          const std::filesystem::path& file, std::vector<std::string>& warnings) {
  RecognisedFormat found;
  found.source = fmt::format("names in line {}", head.names_line);
  found.layout =
      trajectory::layout_of(head, layout_for(TrajectoryFormat::tum, head.columns()), file, warnings);
  if (is_named_openvins(head, reading)) {
    found.format = TrajectoryFormat::openvins;
    found.layout.names = kOpenvinsNames;
    found.layout.explained = kOpenvinsColumns;
    return found;
  }
  found.format = found.layout.columns.w_is_first() ? TrajectoryFormat::euroc : TrajectoryFormat::tum;
  const bool may_be_tum = reading.tum_without_commas && !head.commas();
  if (reading.format && *reading.format != found.format && !may_be_tum) {
    warnings.push_back(
        fmt::format("{}:{}: the columns are named, with w of the quaternion {}: read by these "
                    "names, and not as {}",
                    file.string(), head.names_line, found.layout.columns.w_is_first() ? "first" : "last",
                    to_string(*reading.format)));
  }
  return found;
}

}  // namespace

Result<RecognisedFormat> recognise_format(const PoseHead& head, const TrajectoryReading& reading,
                                          const std::filesystem::path& file,
                                          std::vector<std::string>& warnings) {
  if (head.named && !head.rows.empty()) return by_names(head, reading, file, warnings);
  const bool may_be_tum = reading.tum_without_commas && !head.rows.empty() && !head.commas();
  if (reading.format && !may_be_tum) {
    // TUM text has as many columns, but w last: read as these it gives poses like any others.
    if (*reading.format == TrajectoryFormat::euroc && !head.rows.empty() && !head.commas()) {
      return fail(
          ErrorCode::data_corrupt,
          fmt::format("{}:{}: no commas between the numbers, so that this is no ground truth of EuRoC",
                      file.string(), head.rows.front().line),
          "a timestamp in seconds, tx ty tz, qx qy qz qw between blanks is TUM text: say tum in place "
          "of euroc");
    }
    return without_names(*reading.format, "as given", head);
  }
  if (head.rows.empty()) return without_names(TrajectoryFormat::tum, "assumed", head);
  const auto format = format_by_columns(head, file);
  if (!format) return tl::unexpected(format.error());
  return without_names(*format, "by its columns", head);
}

}  // namespace fusebench::trajectory_files
