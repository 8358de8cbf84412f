#include "datasets/reading/associated_row.hpp"

#include <fmt/format.h>

#include <system_error>

#include "core/base/printable.hpp"
#include "core/io/stamped_rows.hpp"
#include "datasets/reading/image_list.hpp"

namespace fusebench::reading {

namespace {

constexpr std::string_view kColumns = "timestamp filename timestamp filename";

bool in_depth_folder(std::string_view name) {
  return std::filesystem::path(name).parent_path().filename().string().starts_with("depth");
}

Result<AssociatedRow> associated_row(const io::TextTable& table, const std::filesystem::path& folder) {
  const bool depth_first = in_depth_folder(table.text(1));
  if (depth_first == in_depth_folder(table.text(3))) {
    return table.fail_here(
        fmt::format("cannot tell which image is depth: {} or {}", table.text(1), table.text(3)),
        "exactly one of the two must lie in a folder whose name begins with 'depth'");
  }
  if (table.text(0).empty() || table.text(2).empty())
    return table.fail_here("a time is empty", "remove the comma without a value before it");
  for (const std::size_t name : {1U, 3U}) {
    if (auto inside = check_stays_inside(table, table.text(name), folder); !inside)
      return tl::unexpected(inside.error());
  }
  const std::size_t depth = depth_first ? 0 : 2;
  const std::size_t color = 2 - depth;
  return AssociatedRow{std::string(table.text(color)), std::string(table.text(depth)),
                       folder / table.text(color + 1), folder / table.text(depth + 1)};
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

}  // namespace

Result<void> for_each_associated_row(
    const std::filesystem::path& list,
    const std::function<Result<void>(const io::TextTable& table, const AssociatedRow& row)>& use) {
  return io::for_each_row(list, kColumns, [&](const io::TextTable& table) -> Result<void> {
    const auto row = associated_row(table, list.parent_path());
    if (!row) return tl::unexpected(row.error());
    if (auto there = check_images_exist(list, table.line(), *row); !there) return there;
    return use(table, *row);
  });
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
