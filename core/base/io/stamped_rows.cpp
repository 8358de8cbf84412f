#include "core/base/io/stamped_rows.hpp"

#include <fmt/format.h>

#include <optional>

#include "core/base/io/stamp_unit.hpp"
#include "core/base/types.hpp"

namespace fusebench::io {

namespace {

/// unit_of is called with the first row.
Result<void> read_stamped_rows(const std::filesystem::path& file, std::string_view columns, TimeOrder order,
                               const StampedRow& row,
                               const std::function<TimeUnit(const TextTable& first)>& unit_of) {
  TimeOrderCheck clock(order);
  std::optional<TimeUnit> unit;
  return for_each_row(file, columns, [&](const TextTable& table) -> Result<void> {
    if (!unit) unit = unit_of(table);
    const Result<std::int64_t> time_ns = table.time_ns(0, *unit);
    if (!time_ns) return tl::unexpected(time_ns.error());
    if (auto later = clock.take(table, 0, *time_ns); !later) return later;
    return row(table, *time_ns);
  });
}

}  // namespace

Result<void> TimeOrderCheck::take(const TextTable& table, std::size_t column, std::int64_t time_ns) {
  if (order_ == TimeOrder::any) return {};
  if (line_ > 0 && time_ns == time_ns_ && order_ == TimeOrder::increasing) {
    return table.fail_here(
        fmt::format("timestamp {} is the same as that of line {}", table.text(column), line_),
        "remove one of the two rows");
  }
  if (line_ > 0 && time_ns < time_ns_) {
    return table.fail_here(fmt::format("time runs backwards by {} s (timestamp {} after line {})",
                                       seconds_between(time_ns, time_ns_), table.text(column), line_),
                           "sort the file by its stamps, or find out why the clock jumped");
  }
  time_ns_ = time_ns;
  line_ = table.line();
  return {};
}

Result<void> for_each_row(const std::filesystem::path& file, std::string_view columns,
                          const std::function<Result<void>(const TextTable& table)>& row) {
  Result<TextTable> table = TextTable::open(file, columns);
  if (!table) return tl::unexpected(table.error());
  bool empty = true;
  while (true) {
    const Result<bool> got = table->next();
    if (!got) return tl::unexpected(got.error());
    if (!*got) break;
    empty = false;
    if (auto done = row(*table); !done) return done;
  }
  if (!empty) return {};
  return fail(ErrorCode::data_corrupt, fmt::format("{}: has no rows (expected {})", file.string(), columns));
}

Result<void> for_each_row(const std::filesystem::path& file, std::string_view columns,
                          const std::function<Result<void>(const TextTable& table)>& row,
                          std::vector<std::string>& warnings) {
  bool is_first = true;
  return for_each_row(file, columns, [&](const TextTable& table) -> Result<void> {
    if (is_first) table.warn_of_more_columns(warnings);
    is_first = false;
    return row(table);
  });
}

Result<void> for_each_stamped_row(const std::filesystem::path& file, std::string_view columns,
                                  TimeOrder order, const StampedRow& row, TimeUnit unit,
                                  std::vector<std::string>* warnings) {
  return read_stamped_rows(file, columns, order, row, [&](const TextTable& first) {
    if (warnings != nullptr) first.warn_of_more_columns(*warnings);
    return unit;
  });
}

Result<void> for_each_stamped_row(const std::filesystem::path& file, std::string_view columns,
                                  TimeOrder order, const StampedRow& row,
                                  std::vector<std::string>& warnings) {
  return read_stamped_rows(file, columns, order, row, [&](const TextTable& first) {
    const TimeUnit unit = unit_by_size(first.text(0));
    if (unit != TimeUnit::seconds)
      warnings.push_back(fmt::format("{}:{}: stamps are read as {}, by their size", file.string(),
                                     first.line(), to_string(unit)));
    first.warn_of_more_columns(warnings);
    return unit;
  });
}

}  // namespace fusebench::io
