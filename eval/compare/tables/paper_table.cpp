#include "eval/compare/tables/paper_table.hpp"
#include "eval/record/registry/run_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <span>
#include <utility>

#include "datasets/calibration/recording_catalogue.hpp"
#include "eval/record/data_labels.hpp"
#include "eval/record/run_files/run_set.hpp"
#include "eval/text/control_characters.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::tables {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kTextColumns = 3;

/// Names that a recording's folder may have.
std::set<std::string> folder_names(const std::string& recording) {
  std::set<std::string> names;
  if (recording.empty()) return names;
  names.insert(recording);
  if (const calibration::CatalogueEntry* entry = calibration::find_catalogue_entry(recording)) {
    for (const std::string& folder : entry->folders)
      names.insert(std::filesystem::path(folder).filename().string());
  }
  return names;
}

/// A run with its row of the table of results, and the edited options that not all runs share.
struct Place {
  const run_files::FoundRun* run = nullptr;
  const TableRow* row = nullptr;
  const std::string* edits = nullptr;
};

/// All that was run here.
struct RunsHere {
  const std::vector<run_files::FoundRun>& runs;
  ResultTable table;
  std::vector<std::string> edits;
};

bool has_synthetic_imu(const run_files::FoundRun& run) { return run.record.recording.imu == "synthetic IMU"; }

/// Of the runs of a variant that are ok, the first without edited options of its own, else the first.
Place place_of(const RunsHere& here, const std::set<std::string>& names, const std::string& variant,
               bool synthetic_imu) {
  Place best;
  for (const TableRow& row : here.table.rows) {
    const std::size_t i = row.members.front();
    const record::RunRecord& record = here.runs[i].record;
    if (row.status != record::RunStatus::ok || record.variant != variant ||
        !names.contains(record.recording.name) || has_synthetic_imu(here.runs[i]) != synthetic_imu)
      continue;
    if (best.run == nullptr || (here.edits[i].empty() && !best.edits->empty()))
      best = {&here.runs[i], &row, &here.edits[i]};
  }
  return best;
}

/// The variants of the table, then the other ones of which an ok run has the value.
std::vector<std::string> systems_here(const PublishedTable& published,
                                      const std::vector<run_files::FoundRun>& runs) {
  std::vector<std::string> systems = published.variants;
  for (const run_files::FoundRun& run : runs) {
    const record::RunRecord& record = run.record;
    if (record.status == record::RunStatus::ok && registry::number_of(record, *published.value).value &&
        std::ranges::find(systems, record.variant) == systems.end())
      systems.push_back(record.variant);
  }
  const auto others = systems.begin() + static_cast<std::ptrdiff_t>(published.variants.size());
  std::sort(others, systems.end(), [](const std::string& a, const std::string& b) {
    return std::pair(run_files::variant_rank(a), a) < std::pair(run_files::variant_rank(b), b);
  });
  return systems;
}

/// The first over the last.
std::optional<double> ratio_of(std::span<const std::optional<double>> values) {
  if (values.size() < 2 || !values.front() || !values.back() || *values.back() == 0) return std::nullopt;
  return *values.front() / *values.back();
}

/// What was run here of recordings of these names, with an IMU that was made from the ground truth or without
/// one.
void add_here(PaperTable& paper, const RunsHere& here, const std::set<std::string>& names, bool synthetic_imu,
              PaperRow& row) {
  const PublishedTable& published = paper.of;
  std::vector<std::optional<double>> common;
  std::set<std::string> data;
  std::set<std::string> fingerprints;
  for (const std::string& variant : paper.systems_here) {
    const Place place = place_of(here, names, variant, synthetic_imu);
    row.here.push_back(place.row ? place.row->numbers[*published.value] : std::nullopt);
    common.push_back(place.row ? place.row->numbers[registry::kCommonPixelsKey] : std::nullopt);
    if (!place.run) continue;
    const record::RecordedRecording& recording = place.run->record.recording;
    if (row.here.size() <= published.variants.size()) fingerprints.insert(recording.fingerprint);
    if (!place.edits->empty())
      paper.notes.push_back(fmt::format("{}, {} (here): with {}.", recording.name, variant, *place.edits));
    const std::string imu = recording.imu == "synthetic IMU" ? ", synthetic IMU" : "";
    data.insert(fmt::format("{}{}, {} frames", record::data_cell(record::words_of(recording)), imu,
                            recording.frames));
  }
  for (const std::string& words : data) row.data += (row.data.empty() ? "" : "; ") + words;
  if (!published.ratio) return;
  row.published_ratio = ratio_of(row.published);
  if (fingerprints.size() > 1) return;  // of different data, there is no ratio
  const std::size_t count = published.variants.size();
  row.here_ratio = ratio_of(std::span(row.here).first(count));
  row.common_ratio = ratio_of(std::span<const std::optional<double>>(common).first(count));
}

bool has_common_ratio(const PublishedTable& table) { return table.ratio && table.value->key == "aie_grey"; }

text::TableCells heading_of(const PaperTable& paper) {
  const PublishedTable& table = paper.of;
  text::TableCells cells = {"group", "recording", "run here on"};
  for (const std::string& system : table.systems) cells.push_back(system + " (published)");
  if (table.ratio) cells.emplace_back("ratio (published)");
  for (const std::string& system : paper.systems_here) cells.push_back(system + " (here)");
  if (table.ratio) cells.emplace_back("ratio (here)");
  if (has_common_ratio(table)) cells.emplace_back("ratio on common pixels (here)");
  return cells;
}

text::TableCells cells_of(const PublishedTable& table, const PaperRow& row) {
  const registry::RunMetric& value = *table.value;
  text::TableCells cells = {row.group, row.label, row.data.empty() ? "not run" : row.data};
  for (const auto& number : row.published)
    cells.push_back(text::number_cell(number, value.shown_factor, value.decimals));
  if (table.ratio) cells.push_back(text::number_cell(row.published_ratio, 1, 2));
  for (const auto& number : row.here)
    cells.push_back(text::number_cell(number, value.shown_factor, value.decimals));
  if (table.ratio) cells.push_back(text::number_cell(row.here_ratio, 1, 2));
  if (has_common_ratio(table)) cells.push_back(text::number_cell(row.common_ratio, 1, 2));
  return cells;
}

std::vector<std::string> notes_of(const PublishedTable& table) {
  std::vector<std::string> notes = {
      fmt::format("{}: {}.", table.title, table.value->heading),
      fmt::format("Published: {}; {}.", table.source,
                  table.verified ? "read in the source itself" : "NOT verified in the sources"),
      "Here: run with this program, on the recordings that the column names. Columns of the one and the "
      "other are "
      "not of one protocol."};
  if (!table.note.empty()) notes.push_back(table.note);
  return notes;
}

std::string markdown(const PaperTable& table, std::size_t width) {
  std::vector<text::TableCells> lines = {heading_of(table)};
  for (const PaperRow& row : table.rows) lines.push_back(cells_of(table.of, row));
  std::string text = text::markdown_table(lines, kTextColumns, width) + "\n";
  for (const std::string& note : table.notes) text += text::without_controls(note) + "\n";
  return text;
}

std::string latex(const PaperTable& table, const LatexLayout& layout) {
  LatexTable latex;
  latex.caption = fmt::format("{}: published numbers and results of this program.", table.of.title);
  latex.label = table.of.name;
  std::ranges::replace(latex.label, '_', '-');
  latex.heading = heading_of(table);
  latex.text_columns = kTextColumns;
  for (const PaperRow& row : table.rows) latex.lines.push_back({cells_of(table.of, row)});
  latex.footnotes = table.notes;
  return latex_table(latex, layout);
}

std::string csv(const PaperTable& table) {
  std::string text = "table,value,group,recording,from,verified,system,number\n";
  for (const PaperRow& row : table.rows) {
    const auto add = [&](const char* from, bool verified, const std::string& system,
                         const std::optional<double>& number) {
      if (!number) return;
      text += fmt::format("{},{},{},{},{},{},{},{}\n", table.of.name, table.of.value->key,
                          text::csv_cell(row.group), text::csv_cell(row.label), from, verified,
                          text::csv_cell(system), *number);
    };
    for (std::size_t i = 0; i < row.published.size(); ++i)
      add("published", table.of.verified, table.of.systems[i], row.published[i]);
    for (std::size_t i = 0; i < row.here.size(); ++i) add("here", true, table.systems_here[i], row.here[i]);
  }
  return text;
}

std::string json(const PaperTable& table) {
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  Json rows = Json::array();
  for (const PaperRow& row : table.rows) {
    Json published = Json::object();
    for (std::size_t i = 0; i < row.published.size(); ++i)
      published[table.of.systems[i]] = number(row.published[i]);
    Json here = Json::object();
    for (std::size_t i = 0; i < row.here.size(); ++i) here[table.systems_here[i]] = number(row.here[i]);
    rows.push_back({{"group", row.group},
                    {"recording", row.label},
                    {"published", std::move(published)},
                    {"published_ratio", number(row.published_ratio)},
                    {"run_on", row.data},
                    {"here", std::move(here)},
                    {"here_ratio", number(row.here_ratio)},
                    {"here_ratio_common_pixels", number(row.common_ratio)}});
  }
  const Json document = {{"table", table.of.name},       {"title", table.of.title},
                         {"source", table.of.source},    {"verified", table.of.verified},
                         {"value", table.of.value->key}, {"rows", std::move(rows)},
                         {"notes", table.notes}};
  return text::json_text(document) + "\n";
}

}  // namespace

PaperTable paper_table(const PublishedTable& published, const std::vector<run_files::FoundRun>& runs) {
  PaperTable table{published, systems_here(published, runs), {}, notes_of(published)};
  const run_files::RunSet set(runs);
  const RunsHere here{runs, table_of(runs), set.differing_options()};
  if (const std::string shared = set.shared_options(); !shared.empty())
    table.notes.push_back(fmt::format("All runs here: with {}.", shared));
  std::set<std::string> left;
  std::set<std::string> synthetic;
  for (const run_files::FoundRun& run : runs)
    (has_synthetic_imu(run) ? synthetic : left).insert(run.record.recording.name);
  for (const PublishedRow& source : published.rows) {
    PaperRow row{source.group, source.label, {}, source.published, {}, {}, {}, {}};
    const std::set<std::string> names = folder_names(source.recording);
    for (const std::string& name : names) left.erase(name);
    add_here(table, here, names, false, row);
    table.rows.push_back(std::move(row));
  }
  const auto add_alone = [&](const char* group, const std::string& name, bool synthetic_imu) {
    PaperRow row{group, name, {}, std::vector<std::optional<double>>(published.systems.size()),
                 {},    {},   {}, {}};
    add_here(table, here, {name}, synthetic_imu, row);
    if (!row.data.empty()) table.rows.push_back(std::move(row));
  };
  for (const std::string& name : left) add_alone("not published", name, false);
  for (const std::string& name : synthetic) add_alone("IMU made from the ground truth", name, true);
  if (!synthetic.empty()) {
    table.notes.emplace_back(
        "IMU made from the ground truth: these runs use information of the reference, so they compare "
        "variants with each other only. They have rows of their own without published numbers.");
  }
  return table;
}

std::string render_paper_table(const PaperTable& table, TableFormat format, const LatexLayout& layout,
                               std::size_t width) {
  if (format == TableFormat::json) return json(table);
  if (format == TableFormat::latex) return latex(table, layout);
  if (format == TableFormat::csv || format == TableFormat::csv_long) return csv(table);
  return markdown(table, width);
}

}  // namespace fusebench::tables
