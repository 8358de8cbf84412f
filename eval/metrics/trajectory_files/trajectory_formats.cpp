#include "eval/metrics/trajectory_files/trajectory_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <system_error>
#include <utility>

#include "core/base/io/input_file.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/trajectory/pose_head.hpp"
#include "core/base/trajectory/pose_table.hpp"
#include "eval/metrics/trajectory_files/format_recognition.hpp"
#include "eval/metrics/trajectory_files/log_trajectory.hpp"
#include "eval/metrics/trajectory_files/matrix_rows.hpp"

namespace fusebench::trajectory_files {

namespace {

constexpr std::array kNames{
    std::pair{TrajectoryFormat::tum, "tum"}, std::pair{TrajectoryFormat::kitti, "kitti"},
    std::pair{TrajectoryFormat::euroc, "euroc"}, std::pair{TrajectoryFormat::log, "log"},
    std::pair{TrajectoryFormat::openvins, "openvins"}};
constexpr std::array kUnits{
    std::pair{io::TimeUnit::seconds, "s"}, std::pair{io::TimeUnit::milliseconds, "ms"},
    std::pair{io::TimeUnit::microseconds, "us"}, std::pair{io::TimeUnit::nanoseconds, "ns"}};

/// What cannot be read as text, or has no rows, is reported by the readers of rows.
Result<void> check_can_be_opened(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    return fail(
        ErrorCode::data_missing, fmt::format("{}: a folder, where a trajectory is needed", file.string()),
        "of a run it is trajectory.tum, and truth.tum beside it; of a recording mostly groundtruth.txt");
  }
  const bool regular = std::filesystem::is_regular_file(file, ignored);
  if (!std::filesystem::exists(file, ignored) || (regular && !io::input_file(file)))
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be opened", file.string()));
  return {};
}

/// From the six numbers of an upper triangle, row by row.
Matrix3d symmetric(const double* upper) {
  Matrix3d matrix;
  matrix << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2], upper[4], upper[5];
  return matrix;
}

/// The covariances of the current row of an openvins table.
Result<PoseCovariance> covariance_of(const io::TextTable& table) {
  constexpr std::size_t kFirst = 8;
  std::array<double, 12> v{};
  if (auto read = table.numbers(kFirst, v); !read) return tl::unexpected(read.error());
  PoseCovariance covariance{symmetric(v.data()), symmetric(v.data() + 6)};
  if (covariance.orientation_rad2.diagonal().minCoeff() < 0 ||
      covariance.position_m2.diagonal().minCoeff() < 0) {
    return table.fail_here("a variance is below zero",
                           "columns 9, 12 and 14 are variances of the orientation, 15, 18 and 20 of the "
                           "position");
  }
  return covariance;
}

/// Of tum, euroc and openvins.
Result<LoadedTrajectory> read_table(const std::filesystem::path& file, const RecognisedFormat& recognised,
                                    const TrajectoryReading& reading, std::vector<std::string>& warnings) {
  LoadedTrajectory loaded;
  loaded.format = recognised.format;
  const bool has_covariances = loaded.format == TrajectoryFormat::openvins;
  const auto duplicates = has_covariances ? trajectory::Duplicates::error : reading.duplicates;
  const auto take_covariance = [&](const io::TextTable& table) -> Result<void> {
    auto covariance = covariance_of(table);
    if (!covariance) return tl::unexpected(covariance.error());
    loaded.covariances.push_back(*covariance);
    return {};
  };
  const auto check_commas = [&](const io::TextTable& table) -> Result<void> {
    if (table.has_commas()) return {};
    return table.fail_here("no commas between the numbers, as other rows have them");
  };
  const trajectory::PoseRow row = has_covariances           ? trajectory::PoseRow(take_covariance)
                                  : recognised.needs_commas ? trajectory::PoseRow(check_commas)
                                                            : trajectory::PoseRow();
  auto rows =
      trajectory::read_pose_rows(file, recognised.layout, trajectory::order_for(duplicates), warnings, row);
  if (!rows) return tl::unexpected(rows.error());
  auto poses = trajectory::ordered(std::move(*rows), duplicates, file, warnings);
  if (!poses) return tl::unexpected(poses.error());
  loaded.poses = std::move(*poses);
  return loaded;
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
  if (auto openable = check_can_be_opened(file); !openable) return tl::unexpected(openable.error());
  const auto head = trajectory::read_pose_head(file, warnings);
  if (!head) return tl::unexpected(head.error());
  auto recognised = recognise_format(*head, reading, file, warnings);
  if (!recognised) return tl::unexpected(recognised.error());
  if (recognised->format == TrajectoryFormat::log) {
    auto poses = read_log_trajectory(file, warnings);
    if (!poses) return tl::unexpected(poses.error());
    return LoadedTrajectory{recognised->format, std::move(*poses), {}, recognised->source, PoseKey::number};
  }
  trajectory::GivenUnit unit{reading.stamp_unit, reading.unit_of_this_file, {}};
  if (recognised->format == TrajectoryFormat::euroc) unit.usual = io::TimeUnit::nanoseconds;
  const bool has_stamps =
      recognised->format != TrajectoryFormat::kitti || recognised->matrices.key == PoseKey::stamp;
  if (has_stamps)
    recognised->layout.unit =
        trajectory::stamp_unit_of(*head, recognised->layout.columns, unit, file, warnings);
  auto loaded = recognised->format == TrajectoryFormat::kitti
                    ? read_matrix_rows(file, recognised->matrices, recognised->layout.unit,
                                       reading.duplicates, warnings)
                    : read_table(file, *recognised, reading, warnings);
  if (loaded) loaded->format_source = recognised->source;
  return loaded;
}

}  // namespace fusebench::trajectory_files
