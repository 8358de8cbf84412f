#include "eval/compare/tables/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include "eval/compare/tables/common_pixels.hpp"
#include "eval/metrics/intensity_file.hpp"
#include "eval/metrics/intensity_metrics.hpp"
#include "eval/record/clock_note.hpp"
#include "eval/record/data_labels.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/record_files.hpp"
#include "eval/record/run_files/run_set.hpp"
#include "eval/record/truth_contradiction.hpp"

namespace fusebench::tables {

namespace fs = std::filesystem;

namespace {

TableRow row_of(const run_files::FoundRun& run, std::string label) {
  const record::RunRecord& record = run.record;
  TableRow row;
  static_cast<run_files::RunIdentity&>(row) = run_files::identity_of(run);
  row.label = std::move(label);
  row.status = record.status;
  row.reason = record.reason;
  row.silent = record.metrics.silent_frames();
  row.numbers = registry::numbers_of(record);
  row.tracked = record.frames.tracked;
  row.total = record.frames.total;
  row.ok_members = record.status == record::RunStatus::ok ? 1 : 0;
  return row;
}

/// Medians over the replicates that are ok, and the status of the first one that is not.
void add_replicates(const std::vector<run_files::FoundRun>& runs, TableRow& row) {
  row.ok_members = 0;
  for (const std::size_t member : row.members) {
    const record::RunRecord& record = runs[member].record;
    if (record.status == record::RunStatus::ok) {
      row.replicates.push_back(registry::numbers_of(record));
      ++row.ok_members;
    } else if (row.status == record::RunStatus::ok) {
      row.status = record.status;
      row.reason = record.reason;
    }
  }
  if (row.replicates.empty()) return;
  row.numbers = registry::medians_of(row.replicates);
  const auto median = [&](std::string_view key) {
    return static_cast<std::size_t>(std::lround(row.numbers[key].value_or(0)));
  };
  row.tracked = median("frames_tracked");
  if (row.silent) row.silent = median("silent_failures");
}

/// The first run of each group. A row is of all replicates, so that no label names one.
run_files::RunSet rows_of(const run_files::RunSet& set, const std::vector<std::vector<std::size_t>>& groups) {
  std::vector<run_files::RunIdentity> rows;
  for (const auto& group : groups) {
    rows.push_back(set.runs()[group.front()]);
    rows.back().replicate = 0;
  }
  return run_files::RunSet(std::move(rows));
}

/// Whether a run's intensity differences are not those that it wrote; the table says so then.
bool is_damaged(const run_files::FoundRun& run, ResultTable& table) {
  constexpr const char* kFile = "intensity.bin";
  std::error_code ignored;
  if (!fs::exists(run.folder / kFile, ignored)) return false;  // add_common_pixels() checks it
  const auto checked = run_files::check_file(run.folder, run.record, kFile);
  if (checked) return false;
  table.notes.push_back(fmt::format("{}, {}: left out of AIE common: {}", run.record.recording.name,
                                    run.record.variant, checked.error().message));
  return true;
}

/// Fills the common-pixel column, one recording (by content) at a time.
void add_common_pixels(const std::vector<run_files::FoundRun>& runs, ResultTable& table) {
  const auto run_of = [&](std::size_t row) -> const run_files::FoundRun& {
    return runs[table.rows[row].members.front()];
  };
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> groups;  // of rows
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    // An imported run says nothing of intensities.
    const record::RunRecord& record = run_of(i).record;
    if (record.status != record::RunStatus::ok || !record.metrics.aie.value) continue;
    groups[{record.recording.name, record.recording.fingerprint}].push_back(i);
  }
  for (auto& [recording, members] : groups) {
    if (members.size() < 2) continue;
    std::erase_if(members, [&](std::size_t member) { return is_damaged(run_of(member), table); });
    if (members.size() < 2) continue;
    std::vector<fs::path> files;
    for (const std::size_t member : members) files.push_back(run_of(member).folder / "intensity.bin");
    std::error_code ignored;
    if (!std::ranges::all_of(files, [&](const fs::path& file) { return fs::exists(file, ignored); })) {
      table.notes.push_back(
          fmt::format("{}: no AIE on common pixels, which needs runs made with --keep all", recording.first));
      continue;
    }
    const auto common = common_pixel_error(files);
    if (!common) {
      table.notes.push_back(
          fmt::format("{}: no AIE on common pixels: {}", recording.first, common.error().message));
      continue;
    }
    for (std::size_t k = 0; k < members.size(); ++k) {
      table.rows[members[k]].numbers.set(registry::run_metric(registry::kCommonPixelsKey),
                                         (*common)[k].aie_grey);
    }
    const metrics::IntensitySummary& summary = common->front();
    table.notes.push_back(fmt::format(
        "{}: {} runs share {} pixels in {} frames ({} frames have no pixel in common)", recording.first,
        members.size(), summary.pixels, summary.frames, summary.frames_excluded));
  }
}

/// Synthetic or simulated data are never in one mean with others, and neither are other options.
/// labels: of the variant with its options, one a row.
std::vector<TableMean> means_of(const std::vector<TableRow>& rows, const std::vector<std::string>& labels) {
  std::vector<TableMean> means;
  std::vector<std::set<std::string>> recordings;
  // Of a run that failed early or is damaged the frames may be unknown: it is no window of its own.
  std::vector<std::set<std::tuple<std::string, std::size_t, std::size_t>>> windows;
  const auto columns = registry::columns_of(registry::Column::runs);
  std::vector<std::vector<double>> sums;  // by mean and column
  std::vector<std::vector<std::size_t>> counts;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TableRow& row = rows[i];
    const auto same = [&](const TableMean& m) {
      return m.data == row.data && m.imu == row.imu && m.truth == row.truth && m.label == labels[i];
    };
    const auto at = static_cast<std::size_t>(std::ranges::find_if(means, same) - means.begin());
    if (at == means.size()) {
      means.push_back({row.data, row.imu, row.truth, row.variant, labels[i], 0, 0, 0, 0, {}, 0});
      recordings.emplace_back();
      windows.emplace_back();
      sums.emplace_back(columns.size());
      counts.emplace_back(columns.size());
    }
    TableMean& mean = means[at];
    recordings[at].insert(row.recording);
    if (row.total > 0) windows[at].emplace(row.recording, row.first_frame, row.total);
    ++mean.total;
    if (row.status != record::RunStatus::ok) continue;
    ++mean.ok;
    if (row.silent.value_or(0) > 0) ++mean.silent;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto value = row.numbers[*columns[c]];
      if (!value) continue;
      sums[at][c] += *value;
      ++counts[at][c];
    }
  }
  for (std::size_t at = 0; at < means.size(); ++at) {
    means[at].recordings = recordings[at].size();
    means[at].windows = windows[at].size();
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (means[at].ok > 0 && counts[at][c] == means[at].ok)
        means[at].values.set(*columns[c], sums[at][c] / static_cast<double>(means[at].ok));
    }
  }
  std::erase_if(means, [](const TableMean& mean) { return mean.recordings < 2; });
  std::ranges::stable_sort(means, {}, [](const TableMean& m) { return run_files::variant_rank(m.variant); });
  return means;
}

std::vector<std::string> footer_of(const ResultTable& table) {
  std::vector<std::string> footer = {
      "AIE: average intensity error of tracked patches in grey levels (0-255): mean over frames of the mean "
      "over their "
      "visible pixels, before any rejection.",
      "AIE common: the same on the pixels that all ok runs of the recording share (a method cannot gain by "
      "dropping "
      "pixels).",
      "ATE: rmse of positions after SE3 alignment, stamps associated one to one within 0.02 s (TUM). Only "
      "tracked frames "
      "have a pose, so read it with the column tracked.",
      "ATE fitted: the same after the offset between the camera and the motion-capture body was fitted as "
      "well; "
      "- where the motion does not make it observable.",
      "RPE: rmse over 1 s (TUM, fixed delta), no alignment.",
      "fps: whole run, reading included."};
  if (std::ranges::any_of(table.rows, [](const TableRow& row) { return row.silent.value_or(0) > 0; })) {
    footer.push_back(
        "undetected: undetected failures, frames with a pose whose motion over the second before is off by "
        "more than 5 cm or 3 "
        "degrees "
        "(evaluation.silent_*), which the method does not report; a jump, as where a lost tracker finds "
        "itself, counts for that second.");
  }
  if (has_replicates(table)) {
    footer.push_back(
        "A [B, C]: median and range over replicates, runs from initial poses that differ by noise far below "
        "what sensors resolve. sensitivity: range / median of the ATE, the share that is chance. AIE common "
        "is of the first replicate.");
  }
  if (!table.means.empty()) {
    footer.push_back(
        "mean: arithmetic, over the variant's runs that are ok on data of one kind; n/N ok: n of N runs are "
        "ok. "
        "Means over different recordings, or over other frames of them, do not compare.");
  }
  std::vector<record::DataWords> words;
  for (const TableRow& row : table.rows) words.push_back({row.data, row.imu, row.truth});
  for (std::string& footnote : record::data_footnotes(words)) footer.push_back(std::move(footnote));
  return footer;
}

}  // namespace

bool has_replicates(const ResultTable& table) {
  return std::ranges::any_of(table.rows, [](const TableRow& row) { return row.members.size() > 1; });
}

ResultTable table_of(const std::vector<run_files::FoundRun>& runs) {
  ResultTable table;
  const run_files::RunSet set(runs);
  const auto groups = set.replicate_groups();
  const run_files::RunSet rows = rows_of(set, groups);
  const std::vector<std::string> labels = rows.labels();
  const std::vector<std::string> methods = rows.methods();
  const std::vector<std::string> windows = rows.window_labels();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const run_files::FoundRun& first = runs[groups[i].front()];
    TableRow row = row_of(first, labels[i]);
    row.members = groups[i];
    row.window = windows[i];
    if (row.members.size() > 1) add_replicates(runs, row);
    if (const auto note = record::clock_note(first.record))
      table.notes.push_back(fmt::format("{}, {}: {}", row.recording, row.label, *note));
    const auto contradiction = record::noted_contradiction(first.record);
    row.contradicts_truth = contradiction.has_value();
    if (contradiction)
      table.notes.push_back(fmt::format("{}, {}: {}", row.recording, row.label, *contradiction));
    if (row.status != record::RunStatus::ok)
      table.notes.push_back(
          fmt::format("{}, {}: {}: {}", row.recording, row.label, record::to_string(row.status), row.reason));
    table.rows.push_back(std::move(row));
  }
  if (const std::string shared = rows.shared_options(); !shared.empty())
    table.notes.push_back(fmt::format("all runs with {}", shared));
  add_common_pixels(runs, table);
  table.means = means_of(table.rows, methods);
  table.footer = footer_of(table);
  return table;
}

}  // namespace fusebench::tables
