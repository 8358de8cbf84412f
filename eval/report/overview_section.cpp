#include "eval/report/overview_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "eval/compare/findings/overview.hpp"

namespace fusebench::report {

namespace {

using Overview = std::vector<findings::OverviewRow>;

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
  if (cell.members.empty()) return "";
  if (cell.ok == cell.members.size()) return "-";
  return cell.ok == 0 ? std::string(record::to_string(cell.status))
                      : fmt::format("{}/{} ok", cell.ok, cell.members.size());
}

std::string cell_text(const findings::OverviewCell& cell, const registry::RunMetric& metric) {
  std::string text = value_text(cell, metric);
  if (cell.tracked_share) text += fmt::format("\n{} tracked", percent(*cell.tracked_share));
  if (cell.undetected) text += fmt::format("\n{} undetected", *cell.undetected);
  return text;
}

/// Of the first run of the cell that has one; empty: none.
std::string first_picture(const findings::OverviewCell& cell, std::span<const std::string> pictures) {
  for (const std::size_t run : cell.members) {
    if (!pictures[run].empty()) return pictures[run];
  }
  return "";
}

/// "1.04" or "1.04 [1.00, 1.12]".
std::string mean_text(const aggregate::RatioMean& mean) {
  if (!mean.ratio) return "-";
  if (!mean.interval) return fmt::format("{:.2f}", *mean.ratio);
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", *mean.ratio, (*mean.interval)[0], (*mean.interval)[1]);
}

/// A column a method.
page::PageTable by_recording(const findings::Ranking& ranking, const Overview& overview,
                             std::span<const std::string> pictures) {
  page::PageTable table;
  table.sortable = true;
  table.header = {"recording"};
  for (const findings::RankedConfiguration& method : ranking.configurations)
    table.header.push_back(method.label);
  for (const findings::OverviewRow& row : overview) {
    page::PageTable::Row line{{row.recording}, ""};
    line.links = {""};
    for (std::size_t c = 0; c < row.cells.size(); ++c) {
      line.cells.push_back(cell_text(row.cells[c], *ranking.metric));
      line.links.push_back(first_picture(row.cells[c], pictures));
      if (row.cells[c].best) line.best.push_back(c + 1);
    }
    table.rows.push_back(std::move(line));
  }
  if (overview.size() < 2 || ranking.configurations.size() < 2) return table;
  page::PageTable::Row mean{{"mean: times the best"}, "", {}, true};
  for (const findings::RankedConfiguration& method : ranking.configurations) {
    mean.cells.push_back(mean_text(method.mean));
    // Over fewer recordings a mean does not compare with that of the first.
    if (method.mean.ratio && method.recordings < ranking.configurations.front().recordings)
      mean.cells.back() += fmt::format("\nof {} recordings", method.recordings);
    if (method.mean.tied) mean.best.push_back(mean.cells.size() - 1);
  }
  table.rows.push_back(std::move(mean));
  return table;
}

struct Totals {
  double tracked = 0;  ///< sum of shares, over `recordings`
  std::size_t recordings = 0;
  std::optional<std::size_t> undetected;
};

Totals totals_of(const Overview& overview, std::size_t method) {
  Totals totals;
  for (const findings::OverviewRow& row : overview) {
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
page::PageTable by_method(const findings::Ranking& ranking, const Overview& overview,
                          std::span<const std::string> pictures) {
  page::PageTable table;
  table.sortable = true;
  table.header = {"method", "mean: times the best"};
  const std::size_t recordings = overview.size() <= kMostRecordings ? overview.size() : 0;
  for (std::size_t r = 0; r < recordings; ++r) table.header.push_back(overview[r].recording);
  table.header.insert(table.header.end(), {"tracked [%]", "undetected"});
  const std::size_t methods = std::min(ranking.configurations.size(), kMostMethods);
  for (std::size_t c = 0; c < methods; ++c) {
    page::PageTable::Row line{{ranking.configurations[c].label, mean_text(ranking.configurations[c].mean)},
                              ""};
    line.links = {"", ""};
    if (ranking.configurations[c].mean.tied) line.best.push_back(1);
    for (std::size_t r = 0; r < recordings; ++r) {
      const findings::OverviewCell& cell = overview[r].cells[c];
      line.cells.push_back(value_text(cell, *ranking.metric));
      line.links.push_back(first_picture(cell, pictures));
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

bool have_ranges(const Overview& overview) {
  return std::ranges::any_of(overview, [](const findings::OverviewRow& row) {
    return std::ranges::any_of(
        row.cells, [](const auto& cell) { return cell.value && cell.value->least < cell.value->most; });
  });
}

std::string text_of(const findings::Ranking& ranking, const Overview& overview,
                    std::span<const std::string> pictures, bool by_methods) {
  std::string text = "Green: the smallest of a recording, and those whose range overlaps its range.";
  if (have_ranges(overview)) text += " [least, most] over replicates and repetitions.";
  if (by_methods && ranking.configurations.size() > kMostMethods)
    text += fmt::format(" The best {} of {} methods.", kMostMethods, ranking.configurations.size());
  if (by_methods || (overview.size() > 1 && ranking.configurations.size() > 1)) {
    text +=
        " Times the best: geometric mean over recordings of the ratio to the smallest of the recording [95 % "
        "interval by bootstrap]; green: not distinguishable from the smallest.";
  }
  const bool judged = std::ranges::any_of(overview, [](const findings::OverviewRow& row) {
    return std::ranges::any_of(row.cells, [](const auto& cell) { return cell.undetected.has_value(); });
  });
  const bool pictured = std::ranges::any_of(pictures, [](const auto& file) { return !file.empty(); });
  if (pictured) text += " A number leads to a picture of the model.";
  if (judged) text += " Undetected: frames with a wrong pose that the method does not report as lost.";
  return text;
}

}  // namespace

page::PageSection overview_section(const findings::Ranking& ranking, const tables::ResultTable& table,
                                   std::span<const std::string> pictures, bool only) {
  const Overview overview = findings::overview_of(ranking, table);
  const bool by_methods = ranking.configurations.size() > kMostColumns;
  std::string title = fmt::format("{} by {}", ranking.metric->heading,
                                  by_methods ? "method and recording" : "recording and method");
  if (!only) title += fmt::format(": {} data{}", ranking.data_word(), ranking.restrictions());
  return {std::move(title), text_of(ranking, overview, pictures, by_methods),
          by_methods ? by_method(ranking, overview, pictures) : by_recording(ranking, overview, pictures)};
}

}  // namespace fusebench::report
