// The best configurations of a folder of runs.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "eval/compare/aggregate/configurations.hpp"
#include "eval/compare/aggregate/run_rows.hpp"

namespace fusebench::aggregate {

struct BestRequest {
  const registry::RunMetric* metric = nullptr;  ///< of find_ranking_metric()
  std::string group =
      "none";             ///< "none": all recordings; "recording", "variant" or the key of an edited option
  std::size_t most = 10;  ///< configurations that a group shows; 0: all
};

struct BestRow {
  /// 1 of the best and of those that tie with it (RatioMean::tied), else 1 + configurations before it that
  /// are better; without ratios, by more than the spread over replicates. Absent without a mean.
  std::optional<std::size_t> rank;
  ConfigurationSummary configuration;
};

/// The runs of one recording, variant or value of an option, on data of one kind.
struct BestGroup {
  std::string label;
  std::string kind;                     ///< of recording_kinds()
  std::vector<std::string> recordings;  ///< of RunRow::recorded_part()
  std::string headline;                 ///< a sentence: the best, its mean ratio, and those that tie with it
  std::size_t configurations = 0;       ///< of which `rows` are the first
  std::vector<BestRow> rows;
};

struct BestTable {
  const registry::RunMetric* metric = nullptr;
  std::string group;
  std::vector<std::string> options;  ///< keys that any of the configurations edits
  std::vector<BestGroup> groups;
  std::vector<std::string> notes;  ///< what a reader must know: what was left out, and the protocol
};

/// Those that did all of a group's recordings by their mean ratio to the best of each recording (by their
/// mean where a number is not positive), those that tie with the first before the others; then the rest by
/// how many recordings they did. Error usage: a group that no run can be put into, with the keys that are
/// edited.
[[nodiscard]] Result<BestTable> best_configurations(std::span<const RunRow> rows, const BestRequest& request);

/// Why a configuration stands behind others: "failed or lost: fr1_rpy; not run: fr1_xyz". Empty if it did
/// all.
[[nodiscard]] std::string incomplete_note(const ConfigurationSummary& configuration);

enum class BestFormat { markdown, csv, json };
/// Error usage.
[[nodiscard]] Result<BestFormat> parse_best_format(std::string_view text);

/// Markdown shows the units of headings; CSV (RFC 4180) and JSON are SI. width: of a line of Markdown.
[[nodiscard]] std::string render_best(const BestTable& table, BestFormat format, std::size_t width = 0);

}  // namespace fusebench::aggregate
