#include "core/trajectory_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/stamped_rows.hpp"

namespace fusebench {

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr double kSmallestNorm = 1e-3;     // below it there is no direction left in four printed decimals
constexpr double kToleratedExcess = 0.01;  // far above what rounding to four decimals does

/// Poses as they come, and how many quaternions were far from unit length.
struct Rows {
  Trajectory poses;
  std::size_t not_unit = 0;
  int first_not_unit_line = 0;
};

Result<void> take_row(const TextTable& table, std::int64_t time_ns, Rows& rows) {
  Eigen::Matrix<double, 7, 1> v;
  if (auto read = table.numbers(1, {v.data(), 7}); !read) return read;
  const Quaterniond rotation(v[6], v[3], v[4], v[5]);
  const double norm = rotation.norm();
  if (!(norm > kSmallestNorm && std::isfinite(norm))) {
    return table.fail_here(fmt::format("quaternion qx qy qz qw has norm {:g} (expected 1)", norm));
  }
  if (std::abs(norm - 1.0) > kToleratedExcess && rows.not_unit++ == 0) {
    rows.first_not_unit_line = table.line();
  }
  rows.poses.push_back({time_ns, {rotation.normalized(), v.head<3>()}});
  return {};
}

TimeOrder order_for(Duplicates duplicates) {
  switch (duplicates) {
    case Duplicates::error:
      return TimeOrder::increasing;
    case Duplicates::last_in_order:
      return TimeOrder::not_backwards;
    case Duplicates::first:
    case Duplicates::last:
    case Duplicates::as_written:
      break;
  }
  return TimeOrder::any;
}

/// Sorts by time and keeps one pose a stamp. Returns a warning, or nothing if all was in order.
std::string put_in_order(Trajectory& poses, Duplicates duplicates) {
  const std::size_t read = poses.size();
  const auto earlier = [](const StampedPose& a, const StampedPose& b) {
    return a.timestamp_ns < b.timestamp_ns;
  };
  const bool sorted = std::ranges::is_sorted(poses, earlier);
  if (duplicates == Duplicates::as_written)
    return sorted ? "" : "rows are not in order of time (left as they are)";
  if (!sorted) std::ranges::stable_sort(poses, earlier);
  std::size_t kept = 0;  // in place: a second copy of a long trajectory would double the memory
  for (std::size_t i = 0; i < read; ++i) {
    if (kept == 0 || poses[kept - 1].timestamp_ns != poses[i].timestamp_ns) {
      poses[kept++] = poses[i];
    } else if (duplicates != Duplicates::first) {
      poses[kept - 1] = poses[i];
    }
  }
  poses.resize(kept);
  const std::size_t dropped = read - kept;
  if (sorted && dropped == 0) return {};
  return fmt::format("{}{} of {} rows repeat a stamp (the {} one is kept)",
                     sorted ? "" : "rows are not in order of time (sorted); ", dropped, read,
                     duplicates == Duplicates::first ? "first" : "last");
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

Result<Trajectory> read_tum_trajectory(const std::filesystem::path& file, std::vector<std::string>& warnings,
                                       Duplicates duplicates) {
  Rows rows;
  const Result<void> done = for_each_stamped_row(
      file, "timestamp tx ty tz qx qy qz qw", order_for(duplicates),
      [&](const TextTable& table, std::int64_t time_ns) { return take_row(table, time_ns, rows); });
  if (!done) return tl::unexpected(done.error());
  if (rows.not_unit > 0) {
    warnings.push_back(
        fmt::format("{}:{}: {} of {} quaternions are off unit length by more than 1 % (normalised)",
                    file.string(), rows.first_not_unit_line, rows.not_unit, rows.poses.size()));
  }
  if (duplicates != Duplicates::error) {
    const std::string disorder = put_in_order(rows.poses, duplicates);
    if (!disorder.empty()) warnings.push_back(fmt::format("{}: {}", file.string(), disorder));
  }
  return std::move(rows.poses);
}

}  // namespace fusebench
