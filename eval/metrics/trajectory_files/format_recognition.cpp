#include "eval/metrics/trajectory_files/format_recognition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/io/stamp_unit.hpp"
#include "core/base/printable.hpp"

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

/// Integers of nanoseconds with commas between the columns.
bool is_euroc(const PoseHead& head) {
  constexpr std::size_t kNanosecondDigits = 14;  // a day; seconds have not that many
  const std::string& stamp = head.rows.front().fields.front();
  return head.commas() && stamp.size() >= kNanosecondDigits &&
         stamp.find_first_not_of("0123456789") == std::string::npos;
}

/// Entries of rotations are within -1 and 1, and stamps soon are not.
bool has_stamps(const PoseHead& head) {
  constexpr double kMoreThanAnEntry = 2;
  return std::ranges::any_of(head.rows, [](const HeadRow& row) { return row.number(0) > kMoreThanAnEntry; });
}

Result<TrajectoryFormat> format_by_columns(const PoseHead& head, const std::optional<MatrixLayout>& matrices,
                                           const std::filesystem::path& file) {
  const std::size_t columns = head.columns();
  if (columns == kLogHeader) return TrajectoryFormat::log;
  const bool has_last_row = columns == kWholePoseColumns && matrices && !matrices->is_transposed;
  if (has_last_row || (columns > kKittiColumns && matrices && matrices->is_surely_one))
    return TrajectoryFormat::kitti;
  if (columns >= kTumColumns && is_euroc(head)) return TrajectoryFormat::euroc;
  if (columns == kTumColumns) return TrajectoryFormat::tum;
  if (columns == kOpenvinsColumns) return TrajectoryFormat::openvins;
  if (columns == kEurocColumns && head.commas()) return TrajectoryFormat::euroc;
  // A stamp and the matrix of a pose are no quaternion with more columns.
  const bool other_tum = columns > kTumColumns && !has_rotations(head.rows, 1) &&
                         (head.fits(trajectory::kTumColumns) || head.has_split_stamps());
  if (columns == kKittiColumns)
    return other_tum && has_stamps(head) && !has_rotations(head.rows, 0) ? TrajectoryFormat::tum
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
      fmt::format("{}:{}: {} columns are no trajectory (tum has 8 or more, kitti 12 or 16, or one more with "
                  "a stamp or number, euroc 8 or more, log 3, openvins 20)",
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

RecognisedFormat without_names(TrajectoryFormat format, std::string source, const PoseHead& head,
                               const std::optional<MatrixLayout>& matrices, const std::filesystem::path& file,
                               std::vector<std::string>& warnings) {
  RecognisedFormat found{format, std::move(source), layout_for(format, head.columns()), {}, false};
  found.needs_commas = format == TrajectoryFormat::euroc;
  if (format == TrajectoryFormat::kitti) found.matrices = matrices.value_or(MatrixLayout{});
  if (format == TrajectoryFormat::kitti) found.source += found.matrices.described();
  if (format == TrajectoryFormat::tum)
    found.layout = trajectory::layout_of(head, found.layout, file, warnings);
  return found;
}

/// Of a format of stamps and quaternions that is given for matrices.
Result<void> check_no_matrices(const PoseHead& head, TrajectoryFormat given,
                               const std::optional<MatrixLayout>& matrices,
                               const std::filesystem::path& file) {
  const bool of_quaternions = given != TrajectoryFormat::kitti && given != TrajectoryFormat::log;
  if (!of_quaternions || !matrices || !matrices->is_surely_one || head.fits(trajectory::kTumColumns))
    return {};
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}:{}: the {} columns are the matrix of a pose, and not {}", file.string(),
                          head.rows.front().line, head.columns(), to_string(given)),
              fmt::format("say kitti in place of {}", to_string(given)));
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
  const auto matrices = matrix_layout(head, reading.stamp_unit.has_value());
  const auto recognised = [&](TrajectoryFormat format, std::string source) {
    return without_names(format, std::move(source), head, matrices, file, warnings);
  };
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
    if (auto checked = check_no_matrices(head, *reading.format, matrices, file); !checked)
      return tl::unexpected(checked.error());
    return recognised(*reading.format, "as given");
  }
  if (head.rows.empty()) return recognised(TrajectoryFormat::tum, "assumed");
  const auto format = format_by_columns(head, matrices, file);
  if (!format) return tl::unexpected(format.error());
  return recognised(*format, "by its columns");
}

}  // namespace fusebench::trajectory_files
