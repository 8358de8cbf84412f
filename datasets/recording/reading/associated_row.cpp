#include "datasets/recording/reading/associated_row.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "core/base/io/lower_case.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "core/base/printable.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/recording/reading/image_list.hpp"

namespace fusebench::reading {

namespace {

constexpr std::string_view kColumns = "timestamp filename timestamp filename ...";

bool in_depth_folder(std::string_view name) {
  return io::lower_case(std::filesystem::path(name).parent_path().filename().string()).starts_with("depth");
}

bool is_called_depth(std::string_view name) {
  return io::lower_case(name).find("depth") != std::string::npos;
}

/// Whether the first of two images is depth, by their folders, else by their names; nothing if both are, or
/// neither.
std::optional<bool> first_is_depth(std::string_view first, std::string_view second) {
  if (in_depth_folder(first) != in_depth_folder(second)) return in_depth_folder(first);
  if (is_called_depth(first) != is_called_depth(second)) return is_called_depth(first);
  return std::nullopt;
}

Result<AssociatedRow> associated_row(const io::TextTable& table, const std::filesystem::path& folder) {
  const auto depth_first = first_is_depth(table.text(1), table.text(3));
  if (!depth_first) {
    return table.fail_here(
        fmt::format("cannot tell which image is depth: {} or {}", table.text(1), table.text(3)),
        "exactly one of the two must lie in a folder whose name begins with 'depth', or have 'depth' in its "
        "name");
  }
  if (table.text(0).empty() || table.text(2).empty())
    return table.fail_here("a time is empty", "remove the comma without a value before it");
  for (const std::size_t name : {1U, 3U}) {
    if (auto inside = check_stays_inside(table, table.text(name), folder); !inside)
      return tl::unexpected(inside.error());
  }
  const std::size_t depth = *depth_first ? 0 : 2;
  const std::size_t color = 2 - depth;
  return AssociatedRow{std::string(table.text(color)), std::string(table.text(depth)),
                       folder / table.text(color + 1), folder / table.text(depth + 1), table.has(4)};
}

Result<void> check_images_exist(const std::filesystem::path& list, int line, const AssociatedRow& row) {
  for (const auto& file : {row.color_file, row.depth_file}) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) {
      return fail(
          ErrorCode::data_missing,
          fmt::format("{}:{}: image {} does not exist", list.string(), line, printable(file.string(), 500)),
          "unpack the whole recording; names are relative to the list's folder");
    }
  }
  return {};
}

struct RowTimes {
  std::int64_t color_ns;
  std::int64_t depth_ns;
};

Result<RowTimes> times_of(const io::TextTable& table, const AssociatedRow& row) {
  const auto color_ns = io::parse_time_ns(row.color_stamp);
  if (!color_ns) return table.fail_here(color_ns.error().message, color_ns.error().hint);
  const auto depth_ns = io::parse_time_ns(row.depth_stamp);
  if (!depth_ns) return table.fail_here(depth_ns.error().message, depth_ns.error().hint);
  return RowTimes{*color_ns, *depth_ns};
}

}  // namespace

Result<void> add_associated_frames(const std::filesystem::path& list, recording::Recording& recording) {
  return for_each_associated_row(
      list,
      [&](const io::TextTable& table, const AssociatedRow& row) -> Result<void> {
        const auto times = times_of(table, row);
        if (!times) return tl::unexpected(times.error());
        auto& frames = recording.frames;
        if (!frames.empty() && times->color_ns <= frames.back().timestamp_ns) {
          return table.fail_here(
              fmt::format("time {} does not come after {} of the row before", row.color_stamp,
                          trajectory::stamp_text(frames.back().timestamp_ns)),
              "sort the file by the times of colour, and remove rows that repeat one");
        }
        frames.push_back({times->color_ns, times->depth_ns, times->color_ns, times->depth_ns, row.color_file,
                          row.depth_file});
        return {};
      },
      recording.warnings);
}

Result<void> for_each_associated_row(
    const std::filesystem::path& list,
    const std::function<Result<void>(const io::TextTable& table, const AssociatedRow& row)>& use,
    std::vector<std::string>& warnings) {
  const auto take = [&](const io::TextTable& table) -> Result<void> {
    const auto row = associated_row(table, list.parent_path());
    if (!row) return tl::unexpected(row.error());
    if (auto there = check_images_exist(list, table.line(), *row); !there) return there;
    return use(table, *row);
  };
  return io::for_each_row(list, kColumns, take, warnings);
}

std::optional<AssociatedRow> first_associated_row(const std::filesystem::path& list) {
  auto table = io::TextTable::open(list, kColumns);
  if (!table) return std::nullopt;
  const Result<bool> got = table->next();
  if (!got || !*got) return std::nullopt;
  auto row = associated_row(*table, list.parent_path());
  return row ? std::optional<AssociatedRow>(std::move(*row)) : std::nullopt;
}

}  // namespace fusebench::reading
