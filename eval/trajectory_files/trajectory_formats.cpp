#include "eval/trajectory_files/trajectory_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <utility>

#include "core/io/bounded_text.hpp"
#include "core/io/input_file.hpp"
#include "core/io/stamped_rows.hpp"
#include "core/io/text_table.hpp"
#include "core/trajectory/trajectory_file.hpp"
#include "eval/trajectory_files/log_trajectory.hpp"
#include "eval/trajectory_files/nearest_rotation.hpp"

namespace fusebench::trajectory_files {

namespace {

constexpr std::array kNames{
    std::pair{TrajectoryFormat::tum, "tum"}, std::pair{TrajectoryFormat::kitti, "kitti"},
    std::pair{TrajectoryFormat::euroc, "euroc"}, std::pair{TrajectoryFormat::log, "log"},
    std::pair{TrajectoryFormat::openvins, "openvins"}};
constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
constexpr std::size_t kEurocColumns = 17;
constexpr std::size_t kLogHeader = 3;
constexpr std::size_t kOpenvinsColumns = 20;

constexpr std::array kUnits{
    std::pair{io::TimeUnit::seconds, "s"}, std::pair{io::TimeUnit::milliseconds, "ms"},
    std::pair{io::TimeUnit::microseconds, "us"}, std::pair{io::TimeUnit::nanoseconds, "ns"}};

/// What a first row says of its file.
struct FirstRow {
  int line = 0;
  std::size_t columns = 0;
  bool commas = false;
  std::string stamp;
};

/// Of eight columns, an integer of nanoseconds before a comma is EuRoC's.
Result<TrajectoryFormat> format_of(const FirstRow& row, const std::filesystem::path& file) {
  if (row.columns == kKittiColumns) return TrajectoryFormat::kitti;
  if (row.columns == kEurocColumns) return TrajectoryFormat::euroc;
  if (row.columns == kOpenvinsColumns) return TrajectoryFormat::openvins;
  if (row.columns == kLogHeader) return TrajectoryFormat::log;
  constexpr std::size_t kNanosecondDigits = 14;  // a day; seconds have not that many
  const bool integer = row.stamp.find_first_not_of("0123456789") == std::string::npos;
  if (row.columns == kTumColumns)
    return row.commas && integer && row.stamp.size() >= kNanosecondDigits ? TrajectoryFormat::euroc
                                                                          : TrajectoryFormat::tum;
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}:{}: {} columns are no trajectory (tum has 8, kitti 12, euroc 8 or 17, log 3, "
                          "openvins 20)",
                          file.string(), row.line, row.columns),
              "`--format` names the format if the first row does not");
}

/// The unit that a stamp since 1970 can only be in: 1e11 s are in the year 5138, 1e11 ms in 1973.
io::TimeUnit unit_of(const std::string& stamp) {
  const Result<double> value = io::parse_number(stamp);
  constexpr double kMostSeconds = 1e11;
  if (!value || *value < kMostSeconds) return io::TimeUnit::seconds;
  if (*value < 1e3 * kMostSeconds) return io::TimeUnit::milliseconds;
  return *value < 1e6 * kMostSeconds ? io::TimeUnit::microseconds : io::TimeUnit::nanoseconds;
}

Result<FirstRow> first_row(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    return fail(
        ErrorCode::data_missing, fmt::format("{}: a folder, where a trajectory is needed", file.string()),
        "of a run it is trajectory.tum, and truth.tum beside it; of a recording mostly groundtruth.txt");
  }
  std::ifstream stream = io::input_file(file);
  if (!stream) return fail(ErrorCode::data_missing, fmt::format("{}: cannot be opened", file.string()));
  std::string line;
  std::vector<std::string_view> fields;
  for (int number = 1; io::next_line(stream, line); ++number) {
    std::string_view text = line;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    fields.clear();
    io::split_fields(text, fields);
    if (fields.empty() || fields[0].starts_with('#')) continue;
    return FirstRow{number, fields.size(), text.find(',') != std::string_view::npos, std::string(fields[0])};
  }
  return fail(ErrorCode::data_corrupt, fmt::format("{}: has no rows (expected poses)", file.string()));
}

Result<Trajectory> read_euroc(const std::filesystem::path& file, trajectory::Duplicates duplicates,
                              std::vector<std::string>& warnings) {
  trajectory::TrajectoryRows rows;
  const Result<void> done = io::for_each_stamped_row(
      file, "timestamp px py pz qw qx qy qz [vx vy vz wx wy wz ax ay az]", trajectory::order_for(duplicates),
      [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
        // TUM text has as many columns, but w last: read as these it gives poses like any others.
        if (!table.has_commas())
          return table.fail_here("no commas between the numbers, so that this is no ground truth of EuRoC",
                                 "a timestamp in seconds, tx ty tz, qx qy qz qw between blanks is TUM text: "
                                 "say tum in place of euroc");
        Eigen::Matrix<double, 7, 1> v;
        if (auto read = table.numbers(1, {v.data(), 7}); !read) return read;
        return trajectory::take_pose(table, time_ns, v.head<3>(), Quaterniond(v[3], v[4], v[5], v[6]), rows);
      },
      io::TimeUnit::nanoseconds);
  if (!done) return tl::unexpected(done.error());
  return trajectory::ordered(std::move(rows), duplicates, file, warnings);
}

/// From the six numbers of an upper triangle, row by row.
Matrix3d symmetric(const double* upper) {
  Matrix3d matrix;
  matrix << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2], upper[4], upper[5];
  return matrix;
}

Result<LoadedTrajectory> read_openvins(const std::filesystem::path& file, io::TimeUnit unit,
                                       std::vector<std::string>& warnings) {
  trajectory::TrajectoryRows rows;
  LoadedTrajectory loaded;
  loaded.format = TrajectoryFormat::openvins;
  const Result<void> done = io::for_each_stamped_row(
      file, "timestamp tx ty tz qx qy qz qw Pr11 Pr12 Pr13 Pr22 Pr23 Pr33 Pt11 Pt12 Pt13 Pt22 Pt23 Pt33",
      io::TimeOrder::increasing,
      [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
        Eigen::Matrix<double, kOpenvinsColumns - 1, 1> v;
        if (auto read = table.numbers(1, {v.data(), kOpenvinsColumns - 1}); !read) return read;
        const PoseCovariance covariance{symmetric(&v[7]), symmetric(&v[13])};
        if (covariance.orientation_rad2.diagonal().minCoeff() < 0 ||
            covariance.position_m2.diagonal().minCoeff() < 0) {
          return table.fail_here(
              "a variance is below zero",
              "columns 9, 12 and 14 are variances of the orientation, 15, 18 and 20 of the "
              "position");
        }
        loaded.covariances.push_back(covariance);
        return trajectory::take_pose(table, time_ns, v.head<3>(), Quaterniond(v[6], v[3], v[4], v[5]), rows);
      },
      unit);
  if (!done) return tl::unexpected(done.error());
  auto poses = trajectory::ordered(std::move(rows), trajectory::Duplicates::error, file, warnings);
  if (!poses) return tl::unexpected(poses.error());
  loaded.poses = std::move(*poses);
  return loaded;
}

Result<Trajectory> read_kitti(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  constexpr double kNoRotation = 1e-2;
  constexpr double kRounding = 1e-5;  // KITTI's files have six digits
  Trajectory poses;
  double largest = 0;
  int largest_line = 0;
  const Result<void> done = io::for_each_row(
      file, "r11 r12 r13 tx r21 r22 r23 ty r31 r32 r33 tz", [&](const io::TextTable& table) -> Result<void> {
        Eigen::Matrix<double, 3, 4, Eigen::RowMajor> T;
        if (auto read = table.numbers(0, {T.data(), kKittiColumns}); !read) return read;
        const NearestRotation rotation = nearest_rotation(T.leftCols<3>());
        if (!(rotation.deviation < kNoRotation)) {
          return table.fail_here(
              fmt::format("the 3x3 part is no rotation (determinant {:g}, R^T R off identity by {:.2g})",
                          T.leftCols<3>().determinant(), rotation.deviation),
              "a row is the upper 3x4 of the pose, row by row");
        }
        if (auto within = trajectory::check_position(table, T.col(3)); !within) return within;
        if (rotation.deviation > largest) {
          largest = rotation.deviation;
          largest_line = table.line();
        }
        poses.push_back({static_cast<std::int64_t>(poses.size()), {Quaterniond(rotation.R), T.col(3)}});
        return {};
      });
  if (!done) return tl::unexpected(done.error());
  if (largest > kRounding) {
    warnings.push_back(
        fmt::format("{}:{}: rotations are off orthonormal by up to {:.2g} (replaced by the nearest rotation)",
                    file.string(), largest_line, largest));
  }
  return poses;
}

}  // namespace

std::string_view to_string(TrajectoryFormat format) {
  return std::ranges::find(kNames, format, [](const auto& entry) { return entry.first; })->second;
}

Result<TrajectoryFormat> parse_trajectory_format(std::string_view text) {
  for (const auto& [format, name] : kNames) {
    if (text == name) return format;
  }
  return fail(ErrorCode::usage, fmt::format("unknown trajectory format '{}'", text),
              "formats are tum, kitti, euroc, log and openvins");
}

Result<io::TimeUnit> parse_stamp_unit(std::string_view text) {
  for (const auto& [unit, name] : kUnits) {
    if (text == name) return unit;
  }
  return fail(ErrorCode::usage, fmt::format("unknown unit of stamps '{}'", text),
              "units are s, ms, us and ns");
}

std::string kitti_text(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory) {
    const Matrix3d R = pose.T_world_camera.rotation_matrix();
    const Vector3d& t = pose.T_world_camera.translation;
    for (int row = 0; row < 3; ++row)
      fmt::format_to(std::back_inserter(text), "{} {} {} {}{}", R(row, 0), R(row, 1), R(row, 2), t[row],
                     row < 2 ? ' ' : '\n');
  }
  return text;
}

Result<LoadedTrajectory> load_trajectory(const std::filesystem::path& file, const TrajectoryReading& reading,
                                         std::vector<std::string>& warnings) {
  TrajectoryFormat format = reading.format.value_or(TrajectoryFormat::tum);
  io::TimeUnit unit = reading.stamp_unit.value_or(io::TimeUnit::seconds);
  std::error_code ignored;
  const bool once = std::filesystem::exists(file, ignored) &&
                    !std::filesystem::is_regular_file(file, ignored) &&
                    !std::filesystem::is_directory(file, ignored);
  if (!once && !(reading.format && reading.stamp_unit)) {
    const Result<FirstRow> row = first_row(file);
    if (!row) return tl::unexpected(row.error());
    if (!reading.format) {
      const Result<TrajectoryFormat> found = format_of(*row, file);
      if (!found) return tl::unexpected(found.error());
      format = *found;
    }
    const bool counts = format == TrajectoryFormat::tum || format == TrajectoryFormat::openvins;
    if (counts && !reading.stamp_unit) unit = unit_of(row->stamp);
    if (counts && !reading.stamp_unit && unit != io::TimeUnit::seconds)
      warnings.push_back(fmt::format("{}:{}: stamps are read as {}, by their size", file.string(), row->line,
                                     io::to_string(unit)));
  }
  if (format == TrajectoryFormat::openvins) return read_openvins(file, unit, warnings);
  Result<Trajectory> poses = format == TrajectoryFormat::kitti ? read_kitti(file, warnings)
                             : format == TrajectoryFormat::log ? read_log_trajectory(file, warnings)
                             : format == TrajectoryFormat::euroc
                                 ? read_euroc(file, reading.duplicates, warnings)
                                 : trajectory::read_tum_trajectory(file, warnings, reading.duplicates, unit);
  if (!poses) return tl::unexpected(poses.error());
  return LoadedTrajectory{format, std::move(*poses), {}};
}

}  // namespace fusebench::trajectory_files
