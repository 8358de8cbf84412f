#include "eval/compare/tables/systems_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "datasets/calibration/recording_catalogue.hpp"
#include "eval/compare/tables/published_table.hpp"
#include "eval/record/data_labels.hpp"
#include "eval/record/registry/run_numbers.hpp"
#include "eval/record/run_files/run_set.hpp"
#include "eval/text/control_characters.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::tables {

namespace {

using Json = nlohmann::ordered_json;
std::span<const registry::RunMetric* const> columns() {
  return registry::columns_of(registry::Column::systems);
}

constexpr std::size_t kTextColumns = 6;

std::size_t position_of(std::string_view key) {
  return static_cast<std::size_t>(std::ranges::find(columns(), key, &registry::RunMetric::key) -
                                  columns().begin());
}

/// Runs of one system, in one version, over the same frames.
using RunGroup = std::vector<const run_files::FoundRun*>;

bool same_frames(const record::RunRecord& a, const record::RunRecord& b) {
  return a.recording.first_frame == b.recording.first_frame && a.recording.frames == b.recording.frames;
}
/// A run that failed may not say of which kind its poses would have been.
bool says_kind_of_poses(const record::RunRecord& run) {
  return run.status == record::RunStatus::ok || run.final_metrics;
}
/// As far as a row names it.
bool same_name(const record::RunRecord& a, const record::RunRecord& b) {
  const bool both_say = says_kind_of_poses(a) && says_kind_of_poses(b);
  return a.recording.name == b.recording.name && a.variant == b.variant &&
         a.recording.imu == b.recording.imu && (a.poses == b.poses || !both_say);
}

/// After each run that revised its poses the same run with the metrics of these.
std::vector<run_files::FoundRun> with_final_poses(const std::vector<run_files::FoundRun>& found) {
  std::vector<run_files::FoundRun> runs;
  for (const run_files::FoundRun& run : found) {
    runs.push_back(run);
    if (!run.record.final_metrics) continue;
    runs.push_back(run);
    runs.back().record.metrics = *run.record.final_metrics;
    runs.back().record.poses = record::PoseKind::final;
  }
  return runs;
}

std::vector<RunGroup> groups_of(const std::vector<run_files::FoundRun>& runs) {
  std::vector<RunGroup> groups;
  for (const run_files::FoundRun& run : runs) {
    const auto identity = run_files::without_repetition(run_files::identity_of(run));
    const auto same = [&](const RunGroup& group) {
      const record::RunRecord& first = group.front()->record;
      return same_name(first, run.record) &&
             run_files::without_repetition(run_files::identity_of(*group.front())) == identity;
    };
    auto group = std::ranges::find_if(groups, same);
    if (group == groups.end()) group = groups.insert(groups.end(), RunGroup{});
    group->push_back(&run);
  }
  return groups;
}

/// Rows of one name are of different frames, options or versions. edits: those that rows differ in, one a
/// row.
std::string what_tells_apart(const std::vector<RunGroup>& groups, const std::vector<std::string>& edits,
                             std::size_t row) {
  const record::RunRecord& here = groups[row].front()->record;
  bool by_frames = false, by_edits = false, by_version = false;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const record::RunRecord& other = groups[i].front()->record;
    if (i == row || !same_name(here, other)) continue;
    by_frames |= !same_frames(here, other);
    by_edits |= edits[row] != edits[i];
    by_version |= here.config_hash != other.config_hash && edits[row] == edits[i];
  }
  std::string text;
  if (by_edits && !edits[row].empty()) text += " " + edits[row];
  if (by_version) text += " #" + here.config_hash.substr(0, 8);
  if (by_frames)
    text += fmt::format(" [{}:{}]", here.recording.first_frame,
                        here.recording.first_frame + here.recording.frames);
  return text;
}

SystemRow row_of(const RunGroup& runs) {
  const record::RunRecord& first = runs.front()->record;
  SystemRow row;
  row.recording = first.recording.name;
  const record::DataWords words = record::words_of(first.recording);
  row.data = record::data_cell(words);
  row.imu = words.imu;
  row.system = first.variant;
  row.poses = record::to_string(first.poses);
  row.runs = runs.size();
  for (const run_files::FoundRun* const run : runs) {
    const bool ok = run->record.status == record::RunStatus::ok;
    row.ok += ok ? 1 : 0;
    if (!ok && row.reason.empty()) row.reason = run->record.reason;
  }
  std::vector<registry::RunNumbers> numbers;
  for (const run_files::FoundRun* const run : runs) {
    if (run->record.status != record::RunStatus::failed) numbers.push_back(registry::numbers_of(run->record));
  }
  for (const registry::RunMetric* column : columns()) {
    row.values.push_back(registry::median_range(numbers, *column));
  }
  row.sensitivity = registry::sensitivity_of(numbers);
  return row;
}

/// Published ATE of a recording, a row a system.
std::vector<SystemRow> published_rows(const std::string& recording) {
  std::vector<SystemRow> rows;
  for (const char* const name : {"ate_tum", "ate_icl"}) {
    const auto table = published_table(name);
    if (!table) continue;
    for (const PublishedRow& published : table->rows) {
      const calibration::CatalogueEntry* const entry = calibration::find_catalogue_entry(published.recording);
      const auto is_it = [&](const std::string& folder) {
        return std::filesystem::path(folder).filename() == recording;
      };
      if (published.recording != recording &&
          (entry == nullptr || std::ranges::none_of(entry->folders, is_it)))
        continue;
      for (std::size_t i = 0; i < table->systems.size(); ++i) {
        if (!published.published[i]) continue;
        SystemRow row;
        row.recording = recording;
        row.data = "whole recording";
        row.system = table->systems[i];
        row.poses = "published";
        row.values.resize(columns().size());
        row.values[position_of("ate_rmse_m")] =
            registry::MedianRange{*published.published[i], *published.published[i], *published.published[i]};
        rows.push_back(std::move(row));
      }
    }
  }
  return rows;
}

std::string csv(const SystemsTable& table) {
  std::string text = "recording,data,imu,system,poses,runs,ok,reason";
  for (const registry::RunMetric* column : columns())
    text += fmt::format(",{0},{0}_least,{0}_most", column->key);
  text += ",sensitivity\n";
  for (const SystemRow& row : table.rows) {
    text += fmt::format("{},{},{},{},{},{},{},{}", text::csv_cell(row.recording), text::csv_cell(row.data),
                        text::csv_cell(row.imu), text::csv_cell(row.system), row.poses, row.runs, row.ok,
                        text::csv_cell(row.reason));
    for (const auto& value : row.values) {
      text += value ? fmt::format(",{},{},{}", value->median, value->least, value->most) : ",,,";
    }
    text += row.sensitivity ? fmt::format(",{}\n", *row.sensitivity) : ",\n";
  }
  return text;
}

std::string json(const SystemsTable& table) {
  Json rows = Json::array();
  for (const SystemRow& row : table.rows) {
    Json line = {{"recording", row.recording}, {"data", row.data}, {"imu", row.imu}, {"system", row.system},
                 {"poses", row.poses},         {"runs", row.runs}, {"ok", row.ok},   {"reason", row.reason}};
    for (std::size_t i = 0; i < columns().size(); ++i) {
      const auto& value = row.values[i];
      Json& number = line[std::string(columns()[i]->key)];
      number = nullptr;
      if (value) number = {{"median", value->median}, {"least", value->least}, {"most", value->most}};
    }
    line["sensitivity"] = row.sensitivity ? Json(*row.sensitivity) : Json(nullptr);
    rows.push_back(std::move(line));
  }
  return text::json_text({{"rows", rows}, {"protocol", table.footer}}) + "\n";
}

std::string latex(const SystemsTable& table, const LatexLayout& layout) {
  const auto lines = systems_table_cells(table);
  LatexTable latex;
  latex.caption = "Systems: medians over the repetitions and replicates of a run, with their ranges.";
  latex.label = "systems";
  latex.heading = lines.front();
  latex.text_columns = kTextColumns;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    latex.lines.push_back(
        {lines[i], {}, i > 1 && table.rows[i - 1].recording != table.rows[i - 2].recording});
  }
  latex.footnotes = table.notes;
  latex.footnotes.insert(latex.footnotes.end(), table.footer.begin(), table.footer.end());
  return latex_table(latex, layout);
}

std::string markdown(const SystemsTable& table, std::size_t width) {
  std::string text = text::markdown_table(systems_table_cells(table), kTextColumns, width) + "\n";
  for (const std::string& note : table.notes) text += fmt::format("- {}\n", text::without_controls(note));
  if (!table.notes.empty()) text += "\n";
  for (const std::string& line : table.footer) text += line + "\n";
  return text;
}

}  // namespace

const std::optional<registry::MedianRange>& SystemRow::value(std::string_view key) const {
  return values.at(position_of(key));
}

bool is_of_another_system(const record::RunRecord& record) {
  const auto method =
      std::ranges::find(record.config, std::string_view("system.method"), &record::RecordedOption::key);
  if (record.program || record.config.empty()) return true;  // imported runs have no configuration
  return method != record.config.end() && method->value != config::OptionValue(std::string("filter"));
}

bool compares_systems(const std::vector<run_files::FoundRun>& runs) {
  std::set<std::string_view> systems;
  bool others = false, revised = false;
  for (const run_files::FoundRun& run : runs) {
    if (run.state != run_files::RunState::whole) continue;
    systems.insert(run.record.variant);
    others |= is_of_another_system(run.record);
    revised |= run.record.final_metrics.has_value();
  }
  return revised || (others && systems.size() > 1);
}

SystemsTable systems_table_of(const std::vector<run_files::FoundRun>& found) {
  SystemsTable table;
  const std::vector<run_files::FoundRun> runs = with_final_poses(found);
  const std::vector<RunGroup> groups = groups_of(runs);
  std::vector<run_files::RunIdentity> firsts;
  for (const RunGroup& group : groups) firsts.push_back(run_files::identity_of(*group.front()));
  const std::vector<std::string> edits = run_files::RunSet(std::move(firsts)).differing_options();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    table.rows.push_back(row_of(groups[i]));
    SystemRow& row = table.rows.back();
    row.system += what_tells_apart(groups, edits, i);
    if (!row.reason.empty()) {
      table.notes.push_back(fmt::format("{}, {}: {} of {} runs not ok: {}", row.recording, row.system,
                                        row.runs - row.ok, row.runs, row.reason));
    }
    const std::string recording = row.recording;
    const bool last = i + 1 == groups.size() || groups[i + 1].front()->record.recording.name != recording;
    if (!last) continue;
    for (SystemRow& published : published_rows(recording)) table.rows.push_back(std::move(published));
  }
  table.footer = {
      "Medians over the runs of a system (repetitions and replicates) with their ranges; one number where "
      "all are equal. Sensitivity: range / median of the ATE, the share that is chance. Poses: online: "
      "estimated when the frame arrived; final: estimated at the end; published: numbers of publications "
      "(configs/paper) by their own protocols. KEY=VALUE: edited options; #: version of a program or "
      "configuration of a variant; [A:B]: frames, where rows of one system differ in them.",
      "ATE: rmse of positions after alignment, over the frames that have a pose: read it with the column "
      "tracked. AIE of poses: docs/metrics.md. Mesh: mean distance of the reconstruction to the ground-truth "
      "surface, at the final poses if there are any. Undetected: frames with a wrong pose. CPU: user and "
      "system time of all threads by the frames of the recording; of an external program for its whole "
      "process."};
  return table;
}

std::vector<std::vector<std::string>> systems_table_cells(const SystemsTable& table) {
  std::vector<std::vector<std::string>> lines{{"recording", "data", "IMU", "system", "poses", "runs"}};
  for (const registry::RunMetric* column : columns()) lines.front().emplace_back(column->heading);
  lines.front().emplace_back("sensitivity");
  for (const SystemRow& row : table.rows) {
    std::vector<std::string> line{
        row.recording, row.data,  row.imu,
        row.system,    row.poses, row.runs == 0 ? "" : fmt::format("{}/{} ok", row.ok, row.runs)};
    for (std::size_t i = 0; i < columns().size(); ++i)
      line.push_back(registry::shown_text(*columns()[i], row.values[i]));
    line.push_back(row.sensitivity ? fmt::format("{:.2f}", *row.sensitivity) : "");
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string render_systems_table(const SystemsTable& table, TableFormat format, const LatexLayout& layout,
                                 std::size_t width) {
  if (format == TableFormat::json) return json(table);
  if (format == TableFormat::latex) return latex(table, layout);
  if (format == TableFormat::csv || format == TableFormat::csv_long) return csv(table);
  return markdown(table, width);
}

}  // namespace fusebench::tables
