#include "core/base/trajectory/pose_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/io/row_text.hpp"
#include "core/base/printable.hpp"

namespace fusebench::trajectory {

namespace {

using PoseVector = Eigen::Matrix<double, 7, 1>;  // position, then x, y, z, w of the quaternion

constexpr std::string_view kLostFrame = "a number is missing or nan, or the quaternion is 0 0 0 0";

/// Nothing of a lost frame.
Result<std::optional<PoseVector>> pose_numbers(const io::TextTable& table, const PoseColumns& columns) {
  std::array<std::size_t, 7> places{};
  std::ranges::copy(columns.position, places.begin());
  std::ranges::copy(columns.quaternion, places.begin() + 3);
  bool lost = false;
  PoseVector v = PoseVector::Zero();
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (io::is_missing(table.text(places[i]))) {
      lost = true;
      continue;
    }
    const Result<double> number = table.number(places[i]);
    if (!number) return tl::unexpected(number.error());
    v[static_cast<Eigen::Index>(i)] = *number;
  }
  if (lost || v.tail<4>().isZero(0)) return std::optional<PoseVector>();
  v.head<3>() *= columns.metres_per_unit;
  return std::optional(v);
}

/// Of a stamp whose seconds are in another column.
Result<std::int64_t> with_fraction(const io::TextTable& table, const PoseColumns& columns,
                                   std::int64_t seconds_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const Result<std::int64_t> fraction_ns = table.time_ns(*columns.fraction, columns.fraction_unit);
  if (!fraction_ns) return fraction_ns;
  if (seconds_ns % kSecond_ns == 0 && *fraction_ns >= 0 && *fraction_ns < kSecond_ns)
    return seconds_ns + *fraction_ns;
  return table.fail_here(
      fmt::format(
          "the stamp is in two columns, {} and {}, which are not whole seconds and less than a second "
          "beyond them",
          table.text(columns.stamp), table.text(*columns.fraction)),
      "write each stamp into one column, in one unit");
}

Result<std::int64_t> stamp_ns(const io::TextTable& table, const PoseLayout& layout) {
  const Result<std::int64_t> time_ns = table.time_ns(layout.columns.stamp, layout.unit);
  if (time_ns && layout.columns.fraction) return with_fraction(table, layout.columns, *time_ns);
  if (time_ns || !io::parse_number(table.text(layout.columns.stamp))) return time_ns;
  return fail(
      time_ns.error().code, time_ns.error().message,
      fmt::format("stamps are read as {}; in another unit, name it above the rows (# timestamp[ns] tx "
                  "...), or use --stamp_unit of `fusebench eval`",
                  to_string(layout.unit)));
}

struct LostRows {
  std::size_t count = 0;
  int first_line = 0;
};

/// Of a table with rows.
Result<void> check_rows(const std::filesystem::path& file, const TrajectoryRows& rows, const LostRows& lost,
                        std::vector<std::string>& warnings) {
  if (lost.count == 0) return {};
  if (rows.poses.empty()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}:{}: all {} rows are of lost frames ({})", file.string(), lost.first_line,
                            lost.count, kLostFrame),
                "a trajectory needs a pose");
  }
  warnings.push_back(fmt::format("{}:{}: {} of {} rows are of lost frames ({}) and are left out",
                                 file.string(), lost.first_line, lost.count, lost.count + rows.poses.size(),
                                 kLostFrame));
  return {};
}

}  // namespace

PoseLayout layout_of(const PoseHead& head, PoseLayout layout, const std::filesystem::path& file,
                     std::vector<std::string>& warnings) {
  if (!head.named && layout.columns.same_places(kTumColumns) && head.has_split_stamps()) {
    layout.columns = kSplitStampColumns;
    layout.names = "seconds nanoseconds tx ty tz qx qy qz qw ...";
    layout.explained = layout.columns.needed();
    warnings.push_back(fmt::format("{}:{}: stamps are read as seconds and nanoseconds in two columns",
                                   file.string(), head.rows.front().line));
  }
  if (!head.named) return layout;
  layout.columns = head.named->columns;
  layout.explained = head.names.size();
  layout.names_line = head.names_are_comment ? 0 : head.names_line;
  layout.names = io::as_columns(std::span(head.names).first(layout.columns.needed())) + " ...";
  if (!head.named->other_stamp.empty()) {
    warnings.push_back(fmt::format("{}:{}: stamps are those of the column {}; the column {} is not used",
                                   file.string(), head.names_line,
                                   printable(head.names[layout.columns.stamp]), head.named->other_stamp));
  }
  if (layout.columns.metres_per_unit != 1)
    warnings.push_back(
        fmt::format("{}:{}: positions are multiplied by {} to be metres, as their unit is named",
                    file.string(), head.names_line, layout.columns.metres_per_unit));
  return layout;
}

Result<TrajectoryRows> read_pose_rows(const std::filesystem::path& file, const PoseLayout& layout,
                                      io::TimeOrder order, std::vector<std::string>& warnings,
                                      const PoseRow& row) {
  auto table = io::TextTable::open(file, layout.names);
  if (!table) return tl::unexpected(table.error());
  table->leave_out_line(layout.names_line);
  io::TimeOrderCheck clock(order);
  TrajectoryRows rows;
  LostRows lost;
  bool has_rows = false;
  while (true) {
    const Result<bool> got = table->next();
    if (!got) return tl::unexpected(got.error());
    if (!*got) break;
    if (!has_rows) table->warn_of_more_columns(warnings, layout.explained);
    has_rows = true;
    const Result<std::int64_t> time_ns = stamp_ns(*table, layout);
    if (!time_ns) return tl::unexpected(time_ns.error());
    const auto v = pose_numbers(*table, layout.columns);
    if (!v) return tl::unexpected(v.error());
    if (!*v) {
      if (lost.count++ == 0) lost.first_line = table->line();
      continue;
    }
    if (auto later = clock.take(*table, layout.columns.stamp, *time_ns); !later)
      return tl::unexpected(later.error());
    if (auto used = row ? row(*table) : Result<void>(); !used) return tl::unexpected(used.error());
    const PoseVector& pose = **v;
    if (auto taken = take_pose(*table, *time_ns, pose.head<3>(),
                               Quaterniond(pose[6], pose[3], pose[4], pose[5]), rows);
        !taken)
      return tl::unexpected(taken.error());
  }
  if (!has_rows)
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: has no rows (expected {})", file.string(), layout.names));
  if (auto checked = check_rows(file, rows, lost, warnings); !checked) return tl::unexpected(checked.error());
  return rows;
}

}  // namespace fusebench::trajectory
