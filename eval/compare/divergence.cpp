#include "eval/compare/divergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/io/bounded_text.hpp"
#include "core/base/io/input_file.hpp"
#include "core/base/io/text_table.hpp"

namespace fusebench::compare {

namespace fs = std::filesystem;

namespace {

constexpr const char* kTrajectoryFile = "trajectory.tum";

struct Row {
  std::int64_t timestamp_ns = 0;
  std::string stamp;
  std::string pose;  // text, so that equal means the same bytes
  std::array<double, 7> numbers{};
};

Result<std::vector<Row>> read_rows(const fs::path& file) {
  auto table = io::TextTable::open(file, "timestamp tx ty tz qx qy qz qw");
  if (!table) return tl::unexpected(table.error());
  std::vector<Row> rows;
  while (true) {
    const auto more = table->next();
    if (!more) return tl::unexpected(more.error());
    if (!*more) return rows;
    Row row;
    const auto time_ns = table->time_ns(0);
    if (!time_ns) return tl::unexpected(time_ns.error());
    row.timestamp_ns = *time_ns;
    row.stamp = table->text(0);
    for (std::size_t column = 1; column <= row.numbers.size(); ++column) {
      row.pose += table->text(column);
      row.pose += ' ';
    }
    if (auto read = table->numbers(1, row.numbers); !read) return tl::unexpected(read.error());
    if (!rows.empty() && row.timestamp_ns <= rows.back().timestamp_ns)
      return table->fail_here("the stamps of a run's trajectory must grow");
    rows.push_back(std::move(row));
  }
}

/// The frame's number in the run's frames.csv, whose first two columns are the frame and its stamp.
std::optional<std::size_t> frame_at(const fs::path& run, std::int64_t timestamp_ns) {
  std::ifstream stream = io::input_file(run / "frames.csv");
  std::string line;
  if (!io::next_line(stream, line) || !line.starts_with("frame,timestamp,")) return std::nullopt;
  while (io::next_line(stream, line)) {
    const std::size_t first = line.find(',');
    const std::size_t second = first == std::string::npos ? first : line.find(',', first + 1);
    if (second == std::string::npos) return std::nullopt;
    const auto time_ns = io::parse_time_ns(std::string_view(line).substr(first + 1, second - first - 1));
    const auto frame = io::parse_number(std::string_view(line).substr(0, first));
    if (!time_ns || !frame || *frame < 0) return std::nullopt;
    if (*time_ns == timestamp_ns) return static_cast<std::size_t>(*frame);
  }
  return std::nullopt;
}

double angle_rad(const std::array<double, 7>& a, const std::array<double, 7>& b) {
  const Quaterniond qa(a[6], a[3], a[4], a[5]);
  const Quaterniond qb(b[6], b[3], b[4], b[5]);
  return qa.angularDistance(qb);
}

Divergence at_row(const Row& row, std::size_t index, const fs::path& base, const fs::path& fresh) {
  Divergence result;
  result.stamp = row.stamp;
  auto frame = frame_at(fresh, row.timestamp_ns);
  if (!frame) frame = frame_at(base, row.timestamp_ns);
  result.frame = frame.value_or(index);
  return result;
}

}  // namespace

std::string Divergence::text() const {
  const std::string where = fmt::format("differs from frame {} on (stamp {})", frame, stamp);
  if (!only_in.empty()) return fmt::format("{}: only {} tracked it", where, only_in);
  if (moved_m.value_or(0) == 0)
    return fmt::format("{}: turned by {:.3g} deg", where, turned_rad.value_or(0) * kDegreesPerRadian);
  return fmt::format("{}: moved by {:.3g} mm", where, *moved_m * 1000);
}

bool has_trajectory(const fs::path& run) {
  std::error_code error;
  return fs::is_regular_file(run / kTrajectoryFile, error);
}

Result<std::optional<Divergence>> first_divergence(const fs::path& base, const fs::path& fresh) {
  const auto before = read_rows(base / kTrajectoryFile);
  if (!before) return tl::unexpected(before.error());
  const auto after = read_rows(fresh / kTrajectoryFile);
  if (!after) return tl::unexpected(after.error());
  for (std::size_t i = 0; i < std::max(before->size(), after->size()); ++i) {
    const Row* const a = i < before->size() ? &(*before)[i] : nullptr;
    const Row* const b = i < after->size() ? &(*after)[i] : nullptr;
    if (a != nullptr && b != nullptr && a->timestamp_ns == b->timestamp_ns) {
      if (a->pose == b->pose) continue;
      Divergence result = at_row(*b, i, base, fresh);
      const Vector3d from(a->numbers[0], a->numbers[1], a->numbers[2]);
      const Vector3d to(b->numbers[0], b->numbers[1], b->numbers[2]);
      result.moved_m = (to - from).norm();
      result.turned_rad = angle_rad(a->numbers, b->numbers);
      return result;
    }
    const bool only_base = b == nullptr || (a != nullptr && a->timestamp_ns < b->timestamp_ns);
    Divergence result = at_row(only_base ? *a : *b, i, base, fresh);
    result.only_in = only_base ? "BASE" : "NEW";
    return result;
  }
  return std::optional<Divergence>();
}

}  // namespace fusebench::compare
