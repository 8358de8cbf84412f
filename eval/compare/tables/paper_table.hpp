// A published table beside what was run here; the two are never in one column.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/compare/tables/published_table.hpp"
#include "eval/compare/tables/table.hpp"
#include "eval/record/run_files/found_runs.hpp"

namespace fusebench::tables {

struct PaperRow {
  std::string group;
  std::string label;
  std::string data;  ///< of what was run here: "recorded", "recorded, synthetic IMU"; empty: nothing was
  std::vector<std::optional<double>> published;
  std::vector<std::optional<double>> here;  ///< one a system of PaperTable::systems_here
  std::optional<double> published_ratio;
  std::optional<double> here_ratio;
  std::optional<double> common_ratio;  ///< of AIE on common pixels
};

struct PaperTable {
  PublishedTable of;
  /// The variants that the table asks for, then whatever else was run or imported and has the value.
  std::vector<std::string> systems_here;
  /// The published ones, then recordings that were run here and are not published, then what ran here with an
  /// IMU that was made from the ground truth: such a run is next to no published number.
  std::vector<PaperRow> rows;
  std::vector<std::string> notes;
};

/// Runs are found by the folders that the catalogue knows a recording by; of several runs of a variant the
/// first ok one counts that has no edited options which others do not share, else the first, with a note.
[[nodiscard]] PaperTable paper_table(const PublishedTable& published,
                                     const std::vector<run_files::FoundRun>& runs);

/// CSV has a line for each number, with "published" or "here" beside it; numbers of CSV and JSON are in the
/// value's unit. layout: of LaTeX. width: of a line of Markdown.
[[nodiscard]] std::string render_paper_table(const PaperTable& table, TableFormat format,
                                             const LatexLayout& layout = {}, std::size_t width = 0);

}  // namespace fusebench::tables
