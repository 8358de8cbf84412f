#include "core/io/stamped_rows.hpp"

#include <fmt/format.h>

#include "core/base/types.hpp"

namespace fusebench::io {

namespace {

/// Checks the order of successive times.
class Clock {
 public:
  explicit Clock(TimeOrder order) : order_(order) {}

  Result<void> take(const TextTable& table, std::int64_t time_ns) {
    if (order_ == TimeOrder::any) return {};
    if (line_ > 0 && time_ns == time_ns_ && order_ == TimeOrder::increasing) {
      return table.fail_here(fmt::format("timestamp {} is the same as that of line {}", table.text(0), line_),
                             "remove one of the two rows");
    }
    if (line_ > 0 && time_ns < time_ns_) {
      return table.fail_here(fmt::format("time runs backwards by {} s (timestamp {} after line {})",
                                         seconds_between(time_ns, time_ns_), table.text(0), line_),
                             "sort the file by its first column, or find out why the clock jumped");
    }
    time_ns_ = time_ns;
    line_ = table.line();
    return {};
  }

 private:
  TimeOrder order_;
  std::int64_t time_ns_ = 0;
  int line_ = 0;
};

}  // namespace

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

Result<void> for_each_stamped_row(const std::filesystem::path& file, std::string_view columns,
                                  TimeOrder order, const StampedRow& row, TimeUnit unit) {
  Clock clock(order);
  return for_each_row(file, columns, [&](const TextTable& table) -> Result<void> {
    const Result<std::int64_t> time_ns = table.time_ns(0, unit);
    if (!time_ns) return tl::unexpected(time_ns.error());
    if (auto later = clock.take(table, *time_ns); !later) return later;
    return row(table, *time_ns);
  });
}

}  // namespace fusebench::io
