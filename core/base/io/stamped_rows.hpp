// Text tables whose first column is a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/text_table.hpp"

namespace fusebench::io {

enum class TimeOrder {
  increasing,     ///< strictly; a row that breaks it is an error that names both lines
  not_backwards,  ///< stamps may repeat
  any,
};

/// Checks the order of successive times.
class TimeOrderCheck {
 public:
  explicit TimeOrderCheck(TimeOrder order) : order_(order) {}

  /// Of the current row, whose time is in `column`. Error data_corrupt: it breaks the order.
  [[nodiscard]] Result<void> take(const TextTable& table, std::size_t column, std::int64_t time_ns);

 private:
  TimeOrder order_;
  std::int64_t time_ns_ = 0;
  int line_ = 0;
};

/// Calls row for every row of the table, in the order of the file, up to the first error. Errors:
/// data_missing; data_corrupt (those of TextTable, a table without rows); those of row.
[[nodiscard]] Result<void> for_each_row(const std::filesystem::path& file, std::string_view columns,
                                        const std::function<Result<void>(const TextTable& table)>& row);

/// The same; a warning counts columns behind the named ones, which "..." as the last name allows.
[[nodiscard]] Result<void> for_each_row(const std::filesystem::path& file, std::string_view columns,
                                        const std::function<Result<void>(const TextTable& table)>& row,
                                        std::vector<std::string>& warnings);

/// What is done with one row; column 0 is its time.
using StampedRow = std::function<Result<void>(const TextTable& table, std::int64_t time_ns)>;

/// Calls row for every row of the table, in the order of the file, up to the first error. columns: names,
/// separated by blanks, the first one the time in the given unit. Errors: data_missing; data_corrupt (those
/// of TextTable, the order in time, a table without rows); those of row. warnings, where they are given,
/// count columns behind the named ones.
[[nodiscard]] Result<void> for_each_stamped_row(const std::filesystem::path& file, std::string_view columns,
                                                TimeOrder order, const StampedRow& row,
                                                TimeUnit unit = TimeUnit::seconds,
                                                std::vector<std::string>* warnings = nullptr);

/// The same, in the unit of the first stamp by its size (unit_by_size()), with a warning if that is not the
/// second; a warning counts columns behind the named ones.
[[nodiscard]] Result<void> for_each_stamped_row(const std::filesystem::path& file, std::string_view columns,
                                                TimeOrder order, const StampedRow& row,
                                                std::vector<std::string>& warnings);

}  // namespace fusebench::io
