#include "core/base/trajectory/pose_head.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>
#include <utility>

#include "core/base/io/bounded_text.hpp"
#include "core/base/io/input_file.hpp"
#include "core/base/io/row_text.hpp"
#include "core/base/io/stamp_unit.hpp"
#include "core/base/printable.hpp"

namespace fusebench::trajectory {

namespace {

constexpr std::size_t kMostHeadRows = 20;
constexpr std::size_t kMostNames = 200;
constexpr std::size_t kFewestColumns = 8;

/// A line that names all of a pose is kept.
void take_comment(std::string_view line, int number, PoseHead& head) {
  std::vector<std::string> names = io::column_names(line);
  if (names.size() > kMostNames) return;
  auto named = columns_by_name(names);
  if (!named) return;
  head.named = std::move(*named);
  head.names = std::move(names);
  head.names_line = number;
}

Result<void> take_line_of_names(std::string_view line, int number, const std::filesystem::path& file,
                                PoseHead& head) {
  std::vector<std::string> names = io::column_names(line);
  auto named = columns_by_name(names);
  if (!named) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}:{}: a line of names, but {}", file.string(), number, named.error().message),
                "put # before the line, or name the columns timestamp, tx, ty, tz, qx, qy, qz and qw");
  }
  head.named = std::move(*named);
  head.names = std::move(names);
  head.names_line = number;
  head.names_are_comment = false;
  return {};
}

/// Of a row that has the columns of a pose.
Result<void> check_decimal_points(std::string_view line, std::size_t fields, int number,
                                  const std::filesystem::path& file) {
  if (fields < kFewestColumns || !io::has_decimal_commas(line)) return {};
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}:{}: decimal commas in place of decimal points", file.string(), number),
              std::string(io::kDecimalCommaHint));
}

/// Names of a comment that cannot be those of the rows are dropped, with a warning.
Result<void> check_names(const std::filesystem::path& file, PoseHead& head,
                         std::vector<std::string>& warnings) {
  if (!head.named || head.rows.empty() || head.names.size() == head.columns()) return {};
  if (head.names_are_comment) {
    const bool first_ones = head.names.size() < head.columns() && head.named->columns.stamp == 0;
    if (first_ones) return {};
    head.named.reset();
    warnings.push_back(fmt::format(
        "{}:{}: {} names of columns, but line {} has {} columns: names are not used", file.string(),
        head.names_line, head.names.size(), head.rows.front().line, head.columns()));
    return {};
  }
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}:{}: {} columns, but line {} has {} names", file.string(),
                          head.rows.front().line, head.columns(), head.names_line, head.names.size()),
              "name each column, or put # before the line of names");
}

std::string stamp_in(const HeadRow& row, std::size_t column) {
  return column < row.fields.size() ? row.fields[column] : std::string();
}

/// A stamp that cannot be in that unit, if there is one. The range is tested with the first stamp: a later
/// one beyond it is an error of its row. A unit that is given for several files is not that of stamps with
/// decimals, which are in seconds, unless their size is of this unit.
std::optional<std::string> stamp_against(const PoseHead& head, std::size_t column, io::TimeUnit unit,
                                         bool for_several_files) {
  for (std::size_t i = 0; i < head.rows.size(); ++i) {
    std::string stamp = stamp_in(head.rows[i], column);
    if (!io::parse_number(stamp)) continue;
    const bool whole = for_several_files && io::unit_by_size(stamp) != unit;
    const bool possible =
        (i > 0 || io::can_be_in(unit, stamp)) &&
        (unit == io::TimeUnit::seconds || io::stamp_decimals(stamp) <= (whole ? 0 : static_cast<int>(unit)));
    if (!possible) return stamp;
  }
  return std::nullopt;
}

/// Nothing of another text than digits.
std::optional<std::int64_t> whole_number(const std::string& field) {
  if (field.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  const auto value = io::parse_time_ns(field, io::TimeUnit::nanoseconds);
  return value ? std::optional(*value) : std::nullopt;
}

}  // namespace

double HeadRow::number(std::size_t column) const {
  return io::parse_number(fields[column]).value_or(std::numeric_limits<double>::quiet_NaN());
}

double HeadRow::norm(std::size_t first, std::size_t count) const {
  double sum = 0;
  for (std::size_t i = first; i < first + count; ++i) sum += number(i) * number(i);
  return std::sqrt(sum);
}

bool PoseHead::fits(const PoseColumns& columns) const {
  const std::size_t first = *std::ranges::min_element(columns.quaternion);
  return std::ranges::all_of(rows, [&](const HeadRow& row) {
    if (row.fields.size() < columns.needed() || std::isnan(row.number(columns.stamp))) return false;
    const double norm = row.norm(first, 4);
    return norm == 0 || is_unit(norm) ||
           std::any_of(row.fields.begin() + static_cast<std::ptrdiff_t>(columns.position[0]),
                       row.fields.begin() + static_cast<std::ptrdiff_t>(first + 4), io::is_missing);
  });
}

bool PoseHead::has_split_stamps() const {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  if (named || fits(kTumColumns) || !fits(kSplitStampColumns)) return false;
  bool within_one = false;
  std::int64_t before_s = 0;
  std::int64_t before_ns = -1;
  for (const HeadRow& row : rows) {
    const auto s = whole_number(row.fields[0]);
    const auto ns = whole_number(row.fields[1]);
    if (!s || !ns || *ns >= kSecond_ns || *s < before_s) return false;
    if (before_ns >= 0 && *s == before_s) {
      if (*ns <= before_ns) return false;
      within_one = true;
    }
    before_s = *s;
    before_ns = *ns;
  }
  return within_one;
}

Result<PoseHead> read_pose_head(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  PoseHead head;
  std::ifstream stream = io::input_file(file);
  std::string line;
  std::vector<std::string_view> fields;
  for (int number = 1; head.rows.size() < kMostHeadRows && io::next_line(stream, line); ++number) {
    std::string_view text = line;
    if (number == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.find('\0') != text.npos) break;
    io::split_fields(text, fields);
    if (fields.empty()) continue;
    if (fields[0].starts_with('#')) {
      if (head.rows.empty() && head.names_are_comment) take_comment(text, number, head);
      continue;
    }
    if (head.rows.empty() && head.names_are_comment && io::is_line_of_names(fields)) {
      if (auto taken = take_line_of_names(text, number, file, head); !taken)
        return tl::unexpected(taken.error());
      continue;
    }
    if (auto points = check_decimal_points(text, fields.size(), number, file); !points)
      return tl::unexpected(points.error());
    head.rows.push_back({number, {fields.begin(), fields.end()}, text.find(',') != std::string_view::npos});
  }
  if (auto checked = check_names(file, head, warnings); !checked) return tl::unexpected(checked.error());
  return head;
}

io::TimeUnit stamp_unit_of(const PoseHead& head, const PoseColumns& columns, const GivenUnit& given,
                           const std::filesystem::path& file, std::vector<std::string>& warnings) {
  const HeadRow first = head.rows.empty() ? HeadRow{} : head.rows.front();
  const io::TimeUnit by_size = io::unit_by_size(stamp_in(first, columns.stamp));
  const auto against = [&](io::TimeUnit unit, bool for_several_files = false) {
    return stamp_against(head, columns.stamp, unit, for_several_files);
  };
  const auto warn = [&](int line, const std::string& what) {
    warnings.push_back(fmt::format("{}:{}: {}", file.string(), line, what));
  };
  if (columns.unit) {
    if (const auto stamp = against(*columns.unit)) {
      warn(head.names_line, fmt::format("the stamps are named as {}, which {} cannot be: read as {}",
                                        to_string(*columns.unit), printable(*stamp), to_string(by_size)));
      return by_size;
    }
    if (given.unit && *given.unit != *columns.unit)
      warn(head.names_line, fmt::format("the stamps are named as {}: read so, and not as {}",
                                        to_string(*columns.unit), to_string(*given.unit)));
    return *columns.unit;
  }
  if (given.unit) {
    const auto stamp = against(*given.unit, !given.of_this_file);
    if (!stamp || given.of_this_file) return *given.unit;
    warn(first.line, fmt::format("stamps such as {} are no {}: read as {}", printable(*stamp),
                                 to_string(*given.unit), to_string(by_size)));
    return by_size;
  }
  if (given.usual && !against(*given.usual)) return *given.usual;
  if (by_size != io::TimeUnit::seconds)
    warn(first.line, fmt::format("stamps are read as {}, by their size", to_string(by_size)));
  return by_size;
}

}  // namespace fusebench::trajectory
