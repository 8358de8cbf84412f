#include "eval/report/overview_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "eval/findings/overview.hpp"

namespace fusebench::report {

namespace {

constexpr std::size_t kMostColumns = 6;     // methods side by side
constexpr std::size_t kMostRecordings = 8;  // side by side, where methods are rows
constexpr std::size_t kMostMethods = 20;    // rows

std::string percent(double share) {
  // 99.96 % is not all.
  return share < 1 && share > 0.995 ? fmt::format("{:.1f} %", std::min(100 * share, 99.9))
                                    : fmt::format("{:.0f} %", 100 * share);
}

/// "1.22 [1.10, 1.40]"; "lost", "2/3 ok" without a number; empty where it was not run.
std::string value_text(const findings::OverviewCell& cell, const registry::RunMetric& metric) {
  if (cell.value) return registry::shown_text(metric, cell.value);
  if (cell.runs == 0) return "";
  if (cell.ok == cell.runs) return "-";
  return cell.ok == 0 ? std::string(record::to_string(cell.status))
                      : fmt::format("{}/{} ok", cell.ok, cell.runs);
}

std::string cell_text(const findings::OverviewCell& cell, const registry::RunMetric& metric) {
  std::string text = value_text(cell, metric);
  if (cell.tracked_share) text += fmt::format("\n{} tracked", percent(*cell.tracked_share));
  if (cell.undetected) text += fmt::format("\n{} undetected", *cell.undetected);
  return text;
}

/// "1.04" or "1.04 [1.00, 1.12]".
std::string mean_text(const aggregate::RatioMean& mean) {
  if (!mean.ratio) return "-";
  if (!mean.interval) return fmt::format("{:.2f}", *mean.ratio);
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", *mean.ratio, (*mean.interval)[0], (*mean.interval)[1]);
}

/// Whether a mean is over all recordings; others are of fewer and do not compare.
bool is_whole(const aggregate::RatioMean& mean, const findings::Overview& overview) {
  std::size_t most = 0;
  for (const aggregate::RatioMean& other : overview.means) most = std::max(most, other.recordings);
  return mean.ratio && mean.recordings == most;
}

/// A column a method.
page::PageTable by_recording(const findings::Ranking& ranking, const findings::Overview& overview) {
  page::PageTable table;
  table.sortable = true;
  table.header = {"recording"};
  for (const findings::RankedConfiguration& method : ranking.configurations)
    table.header.push_back(method.label);
  for (const findings::OverviewRow& row : overview.rows) {
    page::PageTable::Row line{{row.recording}, ""};
    for (std::size_t c = 0; c < row.cells.size(); ++c) {
      line.cells.push_back(cell_text(row.cells[c], *ranking.metric));
      if (row.cells[c].best) line.best.push_back(c + 1);
    }
    table.rows.push_back(std::move(line));
  }
  if (overview.rows.size() < 2 || ranking.configurations.size() < 2) return table;
  page::PageTable::Row mean{{"mean: times the best"}, "", {}, true};
  for (std::size_t c = 0; c < overview.means.size(); ++c) {
    const aggregate::RatioMean& of_method = overview.means[c];
    mean.cells.push_back(mean_text(of_method));
    if (of_method.ratio && !is_whole(of_method, overview))
      mean.cells.back() += fmt::format("\nof {} recordings", of_method.recordings);
    if (of_method.tied) mean.best.push_back(c + 1);
  }
  table.rows.push_back(std::move(mean));
  return table;
}

struct Totals {
  double tracked = 0;  ///< sum of shares, over `recordings`
  std::size_t recordings = 0;
  std::optional<std::size_t> undetected;
};

Totals totals_of(const findings::Overview& overview, std::size_t method) {
  Totals totals;
  for (const findings::OverviewRow& row : overview.rows) {
    const findings::OverviewCell& cell = row.cells[method];
    if (cell.tracked_share) {
      totals.tracked += *cell.tracked_share;
      ++totals.recordings;
    }
    if (cell.undetected) totals.undetected = totals.undetected.value_or(0) + *cell.undetected;
  }
  return totals;
}

/// A row a method, the best first.
page::PageTable by_method(const findings::Ranking& ranking, const findings::Overview& overview) {
  page::PageTable table;
  table.sortable = true;
  table.header = {"method", "mean: times the best"};
  const std::size_t recordings = overview.rows.size() <= kMostRecordings ? overview.rows.size() : 0;
  for (std::size_t r = 0; r < recordings; ++r) table.header.push_back(overview.rows[r].recording);
  table.header.insert(table.header.end(), {"tracked [%]", "undetected"});
  const std::size_t methods = std::min(ranking.configurations.size(), kMostMethods);
  for (std::size_t c = 0; c < methods; ++c) {
    page::PageTable::Row line{{ranking.configurations[c].label, mean_text(overview.means[c])}, ""};
    if (overview.means[c].tied) line.best.push_back(1);
    for (std::size_t r = 0; r < recordings; ++r) {
      const findings::OverviewCell& cell = overview.rows[r].cells[c];
      line.cells.push_back(value_text(cell, *ranking.metric));
      if (cell.best) line.best.push_back(r + 2);
    }
    const Totals totals = totals_of(overview, c);
    line.cells.push_back(
        totals.recordings == 0
            ? "-"
            : fmt::format("{:.1f}", 100 * totals.tracked / static_cast<double>(totals.recordings)));
    line.cells.push_back(totals.undetected ? fmt::format("{}", *totals.undetected) : "-");
    if (ranking.configurations[c].ok < ranking.configurations[c].runs) line.style = "warning";
    table.rows.push_back(std::move(line));
  }
  return table;
}

bool have_ranges(const findings::Overview& overview) {
  return std::ranges::any_of(overview.rows, [](const findings::OverviewRow& row) {
    return std::ranges::any_of(
        row.cells, [](const auto& cell) { return cell.value && cell.value->least < cell.value->most; });
  });
}

std::string text_of(const findings::Ranking& ranking, const findings::Overview& overview, bool by_methods) {
  std::string text = "Green: the smallest of a recording, and those whose range overlaps its range.";
  if (have_ranges(overview)) text += " [least, most] over replicates and repetitions.";
  if (by_methods && ranking.configurations.size() > kMostMethods)
    text += fmt::format(" The best {} of {} methods.", kMostMethods, ranking.configurations.size());
  if (by_methods || (overview.rows.size() > 1 && ranking.configurations.size() > 1)) {
    text +=
        " Times the best: geometric mean over recordings of the ratio to the smallest of the recording [95 % "
        "interval by bootstrap]; green: not distinguishable from the smallest.";
  }
  const bool judged = std::ranges::any_of(overview.rows, [](const findings::OverviewRow& row) {
    return std::ranges::any_of(row.cells, [](const auto& cell) { return cell.undetected.has_value(); });
  });
  if (judged) text += " Undetected: frames with a wrong pose that the method does not report as lost.";
  return text;
}

}  // namespace

page::PageSection overview_section(const findings::Ranking& ranking, const tables::ResultTable& table,
                                   bool only) {
  const findings::Overview overview = findings::overview_of(ranking, table);
  const bool by_methods = ranking.configurations.size() > kMostColumns;
  std::string title = fmt::format("{} by {}", ranking.metric->heading,
                                  by_methods ? "method and recording" : "recording and method");
  if (!only) title += fmt::format(": {} data", ranking.data_word());
  if (!only && !ranking.frames.empty()) title += ", " + ranking.frames;
  return {std::move(title), text_of(ranking, overview, by_methods),
          by_methods ? by_method(ranking, overview) : by_recording(ranking, overview)};
}

}  // namespace fusebench::report
