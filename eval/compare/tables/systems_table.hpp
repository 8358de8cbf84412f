// Systems beside each other: one row a recording and system, over the repetitions and replicates of its run.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eval/compare/tables/table.hpp"
#include "eval/record/registry/replicated_numbers.hpp"
#include "eval/record/run_files/found_runs.hpp"

namespace fusebench::tables {

struct SystemRow {
  std::string recording;
  std::string data;    ///< "recorded, synthetic IMU", "simulated"
  std::string imu;     ///< that the system used
  std::string system;  ///< variant, or name of the program
  std::string poses;   ///< "online" or "final"; "published" of numbers from elsewhere
  std::size_t runs = 0;
  std::size_t ok = 0;
  std::string reason;  ///< of the first run that is not ok
  /// Of the columns registry::Column::systems, in their order; nothing where no run has the number.
  std::vector<std::optional<registry::MedianRange>> values = {};

  std::optional<double> sensitivity = {};  ///< registry::sensitivity_of()

  [[nodiscard]] const std::optional<registry::MedianRange>& value(std::string_view key) const;
};

struct SystemsTable {
  std::vector<SystemRow> rows;     ///< by recording; then those that ran here, then published numbers
  std::vector<std::string> notes;  ///< how many runs of a row are not ok, and why
  std::vector<std::string> footer;
};

/// Whether a run is not of this program's filter.
[[nodiscard]] bool is_of_another_system(const record::RunRecord& record);

/// Whether such a table says more than one of the filter's variants: there are runs of several systems, or
/// poses that were revised at the end.
[[nodiscard]] bool compares_systems(const std::vector<run_files::FoundRun>& runs);

/// Numbers are over the runs that are ok; published ATE of the recordings that the catalogue knows stands
/// below them.
[[nodiscard]] SystemsTable systems_table_of(const std::vector<run_files::FoundRun>& runs);

/// The heading, then a line a row, as people see them.
[[nodiscard]] std::vector<std::vector<std::string>> systems_table_cells(const SystemsTable& table);

/// csv_long is as csv here. layout: of LaTeX. width: of a line of Markdown.
[[nodiscard]] std::string render_systems_table(const SystemsTable& table, TableFormat format,
                                               const LatexLayout& layout = {}, std::size_t width = 0);

}  // namespace fusebench::tables
