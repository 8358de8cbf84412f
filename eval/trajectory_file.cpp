#include "eval/trajectory_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

namespace fusebench {

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

/// Decimal seconds to nanoseconds without a double in between; digits beyond the ninth are cut.
std::optional<std::int64_t> parse_stamp(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const auto point = text.find('.');
  const std::string_view whole = text.substr(0, point);
  std::string fraction = point == std::string_view::npos ? "" : std::string(text.substr(point + 1));
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (whole.empty() || whole.size() > 10 || !std::all_of(whole.begin(), whole.end(), is_digit) ||
      !std::all_of(fraction.begin(), fraction.end(), is_digit)) {
    return std::nullopt;
  }
  fraction.resize(9, '0');
  std::int64_t seconds = 0;
  std::int64_t nanoseconds = 0;
  std::from_chars(whole.data(), whole.data() + whole.size(), seconds);
  std::from_chars(fraction.data(), fraction.data() + fraction.size(), nanoseconds);
  // At most 9'999'999'999 s, which would overflow beyond 9.22e18 ns.
  if (seconds > 9'000'000'000) return std::nullopt;
  const std::int64_t stamp = seconds * kNanosecondsPerSecond + nanoseconds;
  return negative ? -stamp : stamp;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r,";
  std::vector<std::string_view> fields;
  for (auto begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(kBlanks, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return fields;
}

std::optional<StampedPose> parse_pose(const std::vector<std::string_view>& fields) {
  if (fields.size() != 8) return std::nullopt;
  const auto stamp = parse_stamp(fields[0]);
  if (!stamp) return std::nullopt;
  std::array<double, 7> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string_view field = fields[i + 1];
    const auto read = std::from_chars(field.data(), field.data() + field.size(), numbers[i]);
    if (read.ec != std::errc{} || read.ptr != field.data() + field.size() || !std::isfinite(numbers[i])) {
      return std::nullopt;
    }
  }
  StampedPose pose;
  pose.timestamp_ns = *stamp;
  pose.T_world_camera.translation = {numbers[0], numbers[1], numbers[2]};
  const Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!(rotation.norm() > 1e-6)) return std::nullopt;
  pose.T_world_camera.rotation = rotation.normalized();
  return pose;
}

struct Row {
  StampedPose pose;
  std::size_t line = 0;
};

/// Rows sorted by time (stable) to a trajectory with unique stamps.
Result<Trajectory> unique_stamps(const std::vector<Row>& rows, const std::string& name,
                                 Duplicates duplicates) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (trajectory.empty() || trajectory.back().timestamp_ns != rows[i].pose.timestamp_ns) {
      trajectory.push_back(rows[i].pose);
    } else if (duplicates == Duplicates::error) {
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}:{}: stamp {} was already in line {}", name, rows[i].line,
                              stamp_text(rows[i].pose.timestamp_ns), rows[i - 1].line));
    } else if (duplicates == Duplicates::last) {
      trajectory.back() = rows[i].pose;
    }
  }
  return trajectory;
}

}  // namespace

std::string stamp_text(std::int64_t timestamp_ns) {
  const bool negative = timestamp_ns < 0;
  const std::int64_t magnitude = negative ? -timestamp_ns : timestamp_ns;
  return fmt::format("{}{}.{:09}", negative ? "-" : "", magnitude / kNanosecondsPerSecond,
                     magnitude % kNanosecondsPerSecond);
}

std::string tum_text(const Trajectory& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& pose : trajectory) {
    const Vector3d& t = pose.T_world_camera.translation;
    // q and -q are one rotation; one sign makes files comparable.
    const double sign = pose.T_world_camera.rotation.w() < 0 ? -1.0 : 1.0;
    const Eigen::Vector4d q = sign * pose.T_world_camera.rotation.coeffs();
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {}\n", stamp_text(pose.timestamp_ns),
                   t.x(), t.y(), t.z(), q[0], q[1], q[2], q[3]);
  }
  return text;
}

Result<Trajectory> read_tum_trajectory(const std::filesystem::path& file, Duplicates duplicates) {
  std::ifstream stream(file);
  if (!stream) return fail(ErrorCode::data_missing, fmt::format("{}: cannot be opened", file.string()));
  std::vector<Row> rows;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.empty() || fields[0].starts_with('#')) continue;
    const auto pose = parse_pose(fields);
    if (!pose) {
      return fail(
          ErrorCode::data_corrupt,
          fmt::format(
              "{}:{}: expected 'timestamp tx ty tz qx qy qz qw', eight finite numbers with a non-zero "
              "quaternion",
              file.string(), number));
    }
    rows.push_back({*pose, number});
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.pose.timestamp_ns < b.pose.timestamp_ns; });
  return unique_stamps(rows, file.string(), duplicates);
}

}  // namespace fusebench
