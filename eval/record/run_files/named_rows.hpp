// Tables of a run that are read by the names of their columns.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::run_files {

/// One row; cells may be empty. Valid while its table is read.
class NamedRow {
 public:
  NamedRow(const std::vector<std::string>& names, const std::vector<std::string_view>& cells)
      : names_(names), cells_(cells) {}

  /// Error data_corrupt: no column of that name.
  [[nodiscard]] Result<std::string_view> text(std::string_view name) const;
  /// Nothing of an empty cell. Error data_corrupt, too, for what is no number.
  [[nodiscard]] Result<std::optional<double>> number(std::string_view name) const;
  /// Of seconds. Error data_corrupt.
  [[nodiscard]] Result<std::int64_t> time_ns(std::string_view name) const;

 private:
  const std::vector<std::string>& names_;
  const std::vector<std::string_view>& cells_;
};

/// Calls row for every line after the header, up to the first error. A cell in double quotes may hold commas,
/// and no quotes. Errors: data_missing; data_corrupt with "file:line: ..." (a row of another length; those of
/// row).
[[nodiscard]] Result<void> for_each_named_row(const std::filesystem::path& file,
                                              const std::function<Result<void>(const NamedRow&)>& row);

/// All rows of a table, each as row_of makes it. Errors: those of for_each_named_row().
template <class Row>
[[nodiscard]] Result<std::vector<Row>> read_named_rows(const std::filesystem::path& file,
                                                       Result<Row> (*row_of)(const NamedRow&)) {
  std::vector<Row> rows;
  const auto done = for_each_named_row(file, [&](const NamedRow& cells) {
    return row_of(cells).map([&](Row row) { rows.push_back(std::move(row)); });
  });
  if (!done) return tl::unexpected(done.error());
  return rows;
}

}  // namespace fusebench::run_files
