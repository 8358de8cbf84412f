#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "eval/compare/reproduction/table1.hpp"
#include "eval/compare/tables/latex_table.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::reproduction {

namespace {

using Json = nlohmann::ordered_json;

std::string ratio_cell(const Ratio& ratio) {
  if (ratio.recordings == 0) return ratio.failed > 0 ? "failed" : "-";
  std::string cell = fmt::format("{:.2f}", ratio.ratio);
  if (ratio.interval) cell += fmt::format(" [{:.2f}, {:.2f}]", (*ratio.interval)[0], (*ratio.interval)[1]);
  const double lost = std::max(ratio.dm_lost_share, ratio.ours_lost_share);
  if (lost > 0.005) cell += fmt::format(" ({:.0f} % lost)", 100 * lost);
  return cell;
}

/// "-" where no column has that speed.
std::string mean_cell(double ratio) { return std::isnan(ratio) ? "-" : fmt::format("{:.2f}", ratio); }

std::string pair_cell(double dm_grey, double ours_grey) {
  return std::isnan(dm_grey) ? "-" : fmt::format("{:.2f} / {:.2f}", dm_grey, ours_grey);
}

/// Columns with what their data are, since simulated recordings and synthetic IMUs are labelled wherever they
/// stand.
text::TableCells heading_of(const Table1& table, std::string first) {
  text::TableCells heading{std::move(first)};
  for (const ResultColumn& column : table.columns) {
    const auto recording = std::ranges::find(table.numbers, column.column.group, &RecordingNumbers::group);
    const bool known = recording != table.numbers.end() && !recording->data.empty();
    heading.push_back(known ? fmt::format("{} ({})", column.column.group, recording->data)
                            : column.column.group);
  }
  return heading;
}

text::TableCells published_line(const Table1& table, bool numbers) {
  text::TableCells line{"published"};
  for (const ResultColumn& column : table.columns)
    line.push_back(numbers ? pair_cell(column.published_dm, column.published_ours)
                           : fmt::format("{:.2f}", column.published_ratio()));
  return line;
}

std::string verdict_of(const Pattern& pattern) {
  if (std::isnan(pattern.slow) || std::isnan(pattern.fast)) return "-";
  if (pattern.is_papers()) return "yes";
  return pattern.lost ? "frames lost" : "no";
}

/// DM over Ours by reading and column, and whether that is the paper's pattern.
std::vector<text::TableCells> ratio_lines(const Table1& table, bool factorial) {
  text::TableCells heading = heading_of(table, "reading");
  heading.insert(heading.end(), {"slow", "fast", "pattern"});
  text::TableCells first = published_line(table, false);
  const Pattern published = table.published_pattern();
  first.insert(first.end(), {mean_cell(published.slow), mean_cell(published.fast), ""});
  std::vector<text::TableCells> lines{heading, first};
  for (const std::size_t r : table.readings) {
    if (table.protocol.readings[r].factorial != factorial) continue;
    text::TableCells line{table.protocol.readings[r].name};
    for (const ResultColumn& column : table.columns)
      line.push_back(ratio_cell(ratio_of(table.numbers, r, column.column.group)));
    const Pattern pattern = table.pattern_of(r);
    line.push_back(mean_cell(pattern.slow));
    line.push_back(mean_cell(pattern.fast));
    line.push_back(verdict_of(pattern));
    lines.push_back(std::move(line));
  }
  return lines;
}

/// Grey levels of DM and Ours.
std::vector<text::TableCells> grey_lines(const Table1& table) {
  std::vector<text::TableCells> lines{heading_of(table, "reading"), published_line(table, true)};
  for (const std::size_t r : table.readings) {
    text::TableCells line{table.protocol.readings[r].name};
    for (const ResultColumn& column : table.columns) {
      const Ratio ratio = ratio_of(table.numbers, r, column.column.group);
      line.push_back(pair_cell(ratio.dm_grey, ratio.ours_grey));
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

/// The ratio by each definition of the intensity error, of one reading of the direct method.
std::vector<text::TableCells> definition_lines(const Table1& table, std::size_t reading) {
  std::vector<text::TableCells> lines{heading_of(table, "definition of the intensity error")};
  for (const metrics::IntensityReading& aie : metrics::all_intensity_readings()) {
    text::TableCells line{metrics::to_string(aie)};
    for (const ResultColumn& column : table.columns) {
      const Ratio ratio = ratio_of(table.numbers, reading, column.column.group, aie);
      line.push_back(ratio.recordings == 0 ? "-" : fmt::format("{:.2f}", ratio.ratio));
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string column_list(const Table1& table) {
  std::string text;
  for (const ResultColumn& column : table.columns) {
    std::vector<std::string> names, data;
    for (const RecordingNumbers& numbers : table.numbers) {
      if (numbers.group != column.column.group) continue;
      if (std::ranges::find(names, numbers.recording) == names.end()) names.push_back(numbers.recording);
      if (!numbers.data.empty() && std::ranges::find(data, numbers.data) == data.end())
        data.push_back(numbers.data);
    }
    text += fmt::format("- `{}` for {} ({}): {}. {} ({})\n", column.column.group, column.column.row,
                        column.speed, column.column.is, fmt::join(names, ", "), fmt::join(data, ", "));
  }
  if (!table.absent.empty()) text += fmt::format("- not there: {}\n", fmt::join(table.absent, "; "));
  return text;
}

std::string reading_list(const Table1& table) {
  std::string text;
  for (const std::size_t r : table.readings) {
    const Reading& reading = table.protocol.readings[r];
    if (reading.factorial) continue;
    text += fmt::format("- `{}`: {}. For it: {}. Against it: {}.\n", reading.name, reading.sentence,
                        reading.speaks_for, reading.speaks_against);
  }
  return text;
}

/// Runs without an intensity error, and why: recording, reading, method, reason.
std::vector<text::TableCells> failure_lines(const Table1& table) {
  std::vector<text::TableCells> lines{{"recording", "reading", "method", "reason"}};
  for (const RecordingNumbers& numbers : table.numbers) {
    const std::string& reading = table.protocol.readings[numbers.reading].name;
    if (!numbers.dm.grey) lines.push_back({numbers.recording, reading, "DM", numbers.dm.failure});
    if (!numbers.ours.grey) lines.push_back({numbers.recording, reading, "Ours", numbers.ours.failure});
  }
  return lines;
}

/// The readings whose ratio is shown by each definition of the error: the first, and those with the pattern.
std::vector<std::size_t> readings_to_detail(const Table1& table) {
  std::vector<std::size_t> detailed;
  for (const std::size_t r : table.readings) {
    if (detailed.empty() || table.pattern_of(r).is_papers()) detailed.push_back(r);
  }
  return detailed;
}

constexpr std::string_view kProtocol =
    "Intensity error of the direct method (DM) over that of deformed patches (Ours): geometric mean over "
    "recordings, with the 95 % interval of this mean where there are several (Student's t on the "
    "logarithms). "
    "Published numbers are the paper's; all others were run here. Lost: share of frames that the worse of "
    "the "
    "two methods lost. Pattern: slow at most 1.5, fast at least 1.5 and 1.2 times slow, and no column with "
    "more "
    "than a tenth of the frames lost.\n";

std::string markdown(const Table1& table) {
  std::string text = "## Columns\n\n" + column_list(table) + "\n## Readings\n\n" + reading_list(table);
  text += fmt::format("\n## Ratios\n\n{}\n{}", kProtocol, text::markdown_table(ratio_lines(table, false), 1));
  const auto factors = ratio_lines(table, true);
  if (factors.size() > 2)
    text += "\n## Ratios by prior, pyramid levels and geometry\n\n" + text::markdown_table(factors, 1);
  text += "\n## Grey levels (DM / Ours)\n\n" + text::markdown_table(grey_lines(table), 1);
  for (const std::size_t r : readings_to_detail(table)) {
    text += fmt::format("\n## Ratios by definition of the intensity error: {}\n\n{}",
                        table.protocol.readings[r].name, text::markdown_table(definition_lines(table, r), 1));
  }
  const auto failures = failure_lines(table);
  if (failures.size() > 1) text += "\n## Runs without a number\n\n" + text::markdown_table(failures, 4);
  return text;
}

std::string latex(const Table1& table) {
  auto lines = ratio_lines(table, false);
  const auto factors = ratio_lines(table, true);
  lines.insert(lines.end(), factors.begin() + 2, factors.end());
  tables::LatexTable latex;
  latex.caption = "Ratios of the intensity errors, DM / Ours: published, and by each reading.";
  latex.label = "ratios";
  latex.heading = lines.front();
  for (std::size_t i = 1; i < lines.size(); ++i) latex.lines.push_back({lines[i]});
  latex.footnotes = {std::string(kProtocol)};
  return tables::latex_table(latex, {});
}

Json json_of(const Ratio& ratio) {
  Json json = {{"recordings", ratio.recordings},
               {"failed", ratio.failed},
               {"dm_grey", ratio.dm_grey},
               {"ours_grey", ratio.ours_grey},
               {"ratio", ratio.ratio},
               {"interval_95", nullptr},
               {"dm_lost_share", ratio.dm_lost_share},
               {"ours_lost_share", ratio.ours_lost_share}};
  if (ratio.interval) json["interval_95"] = *ratio.interval;
  return json;
}

Json json_of(const Table1& table, std::size_t r) {
  const Reading& reading = table.protocol.readings[r];
  const Pattern pattern = table.pattern_of(r);
  Json json = {{"name", reading.name},           {"sentence", reading.sentence},
               {"factorial", reading.factorial}, {"dm", reading.dm},
               {"ours", reading.ours},           {"set", reading.set},
               {"set_dm", reading.set_dm},       {"slow", pattern.slow},
               {"fast", pattern.fast},           {"has_papers_pattern", pattern.is_papers()}};
  for (const ResultColumn& column : table.columns) {
    Json& here = json["columns"][column.column.group];
    here = json_of(ratio_of(table.numbers, r, column.column.group));
    for (const metrics::IntensityReading& aie : metrics::all_intensity_readings())
      here["ratio_by_definition"][metrics::to_string(aie)] =
          ratio_of(table.numbers, r, column.column.group, aie).ratio;
  }
  return json;
}

Json json_of(const Table1& table) {
  Json json = {{"protocol", kProtocol}};
  for (const ResultColumn& column : table.columns)
    json["columns"][column.column.group] = {{"row", column.column.row},
                                            {"is", column.column.is},
                                            {"speed", column.speed},
                                            {"published_dm_grey", column.published_dm},
                                            {"published_ours_grey", column.published_ours},
                                            {"published_ratio", column.published_ratio()}};
  json["absent"] = table.absent;
  for (const std::size_t r : table.readings) json["readings"].push_back(json_of(table, r));
  const auto failures = failure_lines(table);
  json["runs_without_number"] = Json::array();
  for (std::size_t i = 1; i < failures.size(); ++i)
    json["runs_without_number"].push_back({{"recording", failures[i][0]},
                                           {"reading", failures[i][1]},
                                           {"method", failures[i][2]},
                                           {"reason", failures[i][3]}});
  return json;
}

page::PageTable page_table(const std::vector<text::TableCells>& lines) {
  page::PageTable table;
  table.header = lines.front();
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const bool published = lines[i].front() == "published";
    table.rows.push_back({lines[i], published || lines[i].back() == "yes" ? "note" : ""});
  }
  return table;
}

page::PageTable readings_table(const Table1& table) {
  page::PageTable readings{{"reading", "what it is", "for it in the text", "against it"}, {}};
  for (const std::size_t r : table.readings) {
    const Reading& reading = table.protocol.readings[r];
    if (!reading.factorial)
      readings.rows.push_back(
          {{reading.name, reading.sentence, reading.speaks_for, reading.speaks_against}, ""});
  }
  return readings;
}

page::PageTable columns_table(const Table1& table) {
  page::PageTable columns{{"column", "replaces", "speed", "what it is"}, {}};
  for (const ResultColumn& column : table.columns)
    columns.rows.push_back({{column.column.group, column.column.row, column.speed, column.column.is}, ""});
  for (const std::string& absent : table.absent) columns.rows.push_back({{absent, "", "", "not there"}, ""});
  return columns;
}

}  // namespace

page::Page table1_page(const Table1& table) {
  page::Page page;
  page.title = "The paper's Table 1, by each way to read it";
  page.subtitle = "Ratios of the intensity error of a direct method to that of deformed patches.";
  page.sections.push_back({"Ratios", std::string(kProtocol), page_table(ratio_lines(table, false))});
  const auto factors = ratio_lines(table, true);
  if (factors.size() > 2)
    page.sections.push_back({"By prior, pyramid levels and geometry", "", page_table(factors)});
  page.sections.push_back({"Grey levels (DM / Ours)", "", page_table(grey_lines(table))});
  for (const std::size_t r : readings_to_detail(table))
    page.sections.push_back({"By definition of the error: " + table.protocol.readings[r].name, "",
                             page_table(definition_lines(table, r))});
  const auto failures = failure_lines(table);
  if (failures.size() > 1) page.sections.push_back({"Runs without a number", "", page_table(failures)});
  page.sections.push_back({"Readings", "", readings_table(table)});
  page.sections.push_back({"Columns", "", columns_table(table)});
  return page;
}

std::string render_table1(const Table1& table, const std::string& format) {
  if (format == "json") return text::json_text(json_of(table));
  return format == "latex" ? latex(table) : markdown(table);
}

}  // namespace fusebench::reproduction
