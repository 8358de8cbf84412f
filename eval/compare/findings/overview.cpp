#include "eval/compare/findings/overview.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

namespace fusebench::findings {

namespace {

/// A recording, or a window of it: its name, first frame, and frames.
using Window = std::tuple<std::string, std::size_t, std::size_t>;

/// The windows of the ranking's runs, by name. Of a run that failed early the frames are unknown: it belongs
/// to the first window of its recording.
std::vector<Window> windows_of(const Ranking& ranking, const tables::ResultTable& table) {
  std::set<Window> windows;
  std::set<std::string> unknown;
  for (const RankedConfiguration& configuration : ranking.configurations) {
    for (const std::size_t i : configuration.rows) {
      const tables::TableRow& row = table.rows[i];
      if (row.frames > 0) windows.emplace(row.recording, row.first_frame, row.frames);
      if (row.frames == 0) unknown.insert(row.recording);
    }
  }
  const auto has = [&](const std::string& name) {
    return std::ranges::any_of(windows, [&](const Window& window) { return std::get<0>(window) == name; });
  };
  for (const std::string& name : unknown) {
    if (!has(name)) windows.emplace(name, 0, 0);
  }
  return {windows.begin(), windows.end()};
}

std::string label_of(const Window& window, const tables::ResultTable& table) {
  const auto& [name, first, frames] = window;
  const auto row = std::ranges::find_if(table.rows, [&](const tables::TableRow& r) {
    return Window(r.recording, r.first_frame, r.frames) == window;
  });
  return row == table.rows.end() ? name : row->recorded_part();
}

std::size_t place_of(const tables::TableRow& row, const std::vector<Window>& windows) {
  const auto is_of = [&](const Window& window) {
    return std::get<0>(window) == row.recording &&
           (row.frames == 0 || window == Window(row.recording, row.first_frame, row.frames));
  };
  return static_cast<std::size_t>(std::ranges::find_if(windows, is_of) - windows.begin());
}

/// What the rows of a cell have, until all are there.
struct Tally {
  OverviewCell cell;
  double sum = 0;  ///< of the numbers of rows, and their count
  std::size_t count = 0;
  std::vector<double> values;  ///< of runs
  std::size_t tracked = 0;
  std::size_t total = 0;
};

void add(const tables::TableRow& row, const registry::RunMetric& metric, Tally& tally) {
  tally.cell.members.insert(tally.cell.members.end(), row.members.begin(), row.members.end());
  tally.cell.ok += row.ok_members;
  tally.tracked += row.tracked;
  tally.total += row.total;
  if (row.silent) tally.cell.undetected = std::max(tally.cell.undetected.value_or(0), *row.silent);
  if (row.status != record::RunStatus::ok) {
    if (tally.cell.status == record::RunStatus::ok) tally.cell.status = row.status;
    return;
  }
  const auto number = row.numbers[metric];
  if (!number || !(*number > 0)) return;
  tally.sum += *number;
  ++tally.count;
  const std::size_t before = tally.values.size();
  for (const registry::RunNumbers& replicate : row.replicates) {
    if (const auto value = replicate[metric]; value && *value > 0) tally.values.push_back(*value);
  }
  if (tally.values.size() == before) tally.values.push_back(*number);
}

OverviewCell finished(const Tally& tally) {
  OverviewCell cell = tally.cell;
  if (tally.total > 0)
    cell.tracked_share = static_cast<double>(tally.tracked) / static_cast<double>(tally.total);
  if (tally.count == 0) return cell;
  cell.value = registry::median_range(tally.values);
  cell.value->median = tally.sum / static_cast<double>(tally.count);
  return cell;
}

/// A run that tracked few frames is never the best.
void mark_best(OverviewRow& row) {
  double most_tracked = 0;
  std::size_t numbers = 0;
  for (const OverviewCell& cell : row.cells) {
    if (!cell.value) continue;
    ++numbers;
    most_tracked = std::max(most_tracked, cell.tracked_share.value_or(0));
  }
  if (numbers < 2) return;
  const auto compares = [&](const OverviewCell& cell) {
    return cell.value && cell.tracked_share.value_or(0) >= tables::kLeastCoverage * most_tracked;
  };
  const OverviewCell* best = nullptr;
  for (const OverviewCell& cell : row.cells) {
    if (compares(cell) && (best == nullptr || cell.value->median < best->value->median)) best = &cell;
  }
  const registry::MedianRange range = *best->value;
  for (OverviewCell& cell : row.cells) cell.best = compares(cell) && cell.value->overlaps(range);
}

}  // namespace

std::vector<OverviewRow> overview_of(const Ranking& ranking, const tables::ResultTable& table) {
  const std::vector<Window> windows = windows_of(ranking, table);
  const std::size_t methods = ranking.configurations.size();
  std::vector<std::vector<Tally>> tallies(windows.size(), std::vector<Tally>(methods));
  for (std::size_t c = 0; c < methods; ++c) {
    for (const std::size_t i : ranking.configurations[c].rows)
      add(table.rows[i], *ranking.metric, tallies[place_of(table.rows[i], windows)][c]);
  }
  std::vector<OverviewRow> rows;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    OverviewRow row{label_of(windows[w], table), {}};
    for (const Tally& tally : tallies[w]) row.cells.push_back(finished(tally));
    mark_best(row);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace fusebench::findings
