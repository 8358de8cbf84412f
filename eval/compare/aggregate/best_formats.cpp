#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "eval/compare/aggregate/best.hpp"
#include "eval/text/control_characters.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::aggregate {

namespace {

using Json = nlohmann::ordered_json;

std::string option_cell(const RunOptions& options, const std::string& key) {
  for (const auto& [name, value] : options) {
    if (name == key) return value;
  }
  return {};
}

/// The mean with its range over replicates.
std::string mean_cell(const registry::RunMetric& metric, const ConfigurationSummary& configuration) {
  if (!configuration.mean) return "-";
  registry::MedianRange range = *configuration.spread;
  range.median = *configuration.mean;
  return registry::shown_text(metric, std::optional(range));
}

std::string ratio_cell(const RatioMean& ratio) {
  return ratio.ratio ? fmt::format("{:.2f}", *ratio.ratio) : "-";
}

std::string interval_cell(const RatioMean& ratio) {
  return ratio.interval ? fmt::format("{:.2f} to {:.2f}", (*ratio.interval)[0], (*ratio.interval)[1]) : "-";
}

/// "1.2,1.1,1.3,true": the ratio, its interval, and whether it ties with the best; empty where there is none.
std::string ratio_csv(const RatioMean& ratio) {
  const std::string interval =
      ratio.interval ? fmt::format("{},{}", (*ratio.interval)[0], (*ratio.interval)[1]) : ",";
  return ratio.ratio ? fmt::format("{},{},{}", *ratio.ratio, interval, ratio.tied) : ",,,";
}

/// The sentences of few groups stand above the table.
std::string headlines(const BestTable& table) {
  constexpr std::size_t kMostGroups = 8;
  if (table.groups.empty() || table.groups.size() > kMostGroups) return "";
  std::string text;
  for (const BestGroup& group : table.groups) text += text::without_controls(group.headline) + "\n";
  return text + "\n";
}

std::string markdown(const BestTable& table, std::size_t width) {
  text::TableCells header = {table.group == "none" ? "group" : table.group, "data", "variant", "imu"};
  header.insert(header.end(), table.options.begin(), table.options.end());
  const std::size_t text_columns = header.size();
  header.insert(header.end(), {"rank", "times the best", "95 % interval", std::string(table.metric->heading),
                               "ok", "incomplete"});
  std::vector<text::TableCells> lines = {header};
  std::string more;
  for (const BestGroup& group : table.groups) {
    for (const BestRow& row : group.rows) {
      text::TableCells cells = {group.label, group.kind, row.configuration.variant, row.configuration.imu};
      for (const std::string& key : table.options)
        cells.push_back(option_cell(row.configuration.options, key));
      cells.push_back(row.rank ? fmt::format("{}", *row.rank) : "-");
      cells.push_back(ratio_cell(row.configuration.ratio));
      cells.push_back(interval_cell(row.configuration.ratio));
      cells.push_back(mean_cell(*table.metric, row.configuration));
      cells.push_back(fmt::format("{}/{}", row.configuration.n_ok, row.configuration.n_total));
      cells.push_back(incomplete_note(row.configuration));
      lines.push_back(std::move(cells));
    }
    if (group.rows.size() < group.configurations) {
      more += fmt::format("- {} ({}): {} of {} configurations shown\n", group.label, group.kind,
                          group.rows.size(), group.configurations);
    }
  }
  // No run has the number: the notes say so.
  std::string text = table.groups.empty()
                         ? ""
                         : headlines(table) + text::markdown_table(lines, text_columns, width) + "\n" + more;
  for (const std::string& note : table.notes) text += fmt::format("- {}\n", note);
  return text;
}

std::string csv(const BestTable& table) {
  std::string text = "group,data,rank,variant,imu";
  for (const std::string& key : table.options) text += fmt::format(",{}", text::csv_cell(key));
  text += ",metric,unit,mean,least,most,n_ok,n_total,recordings,note,ratio,ratio_least,ratio_most,tied\n";
  for (const BestGroup& group : table.groups) {
    for (const BestRow& row : group.rows) {
      const ConfigurationSummary& configuration = row.configuration;
      text += fmt::format("{},{},{},{},{}", text::csv_cell(group.label), text::csv_cell(group.kind),
                          row.rank ? fmt::format("{}", *row.rank) : "", text::csv_cell(configuration.variant),
                          text::csv_cell(configuration.imu));
      for (const std::string& key : table.options)
        text += fmt::format(",{}", text::csv_cell(option_cell(configuration.options, key)));
      text += fmt::format(",{},{},{},{},{},{},{},{}\n", table.metric->key, table.metric->unit,
                          configuration.mean
                              ? fmt::format("{},{},{}", *configuration.mean, configuration.spread->least,
                                            configuration.spread->most)
                              : ",,",
                          configuration.n_ok, configuration.n_total, group.recordings.size(),
                          text::csv_cell(incomplete_note(configuration)), ratio_csv(configuration.ratio));
    }
  }
  return text;
}

Json json_of(const BestRow& row) {
  Json options = Json::object();
  for (const auto& [key, value] : row.configuration.options) options[key] = value;
  return {{"rank", row.rank ? Json(*row.rank) : Json(nullptr)},
          {"variant", row.configuration.variant},
          {"imu", row.configuration.imu},
          {"options", std::move(options)},
          {"mean", row.configuration.mean ? Json(*row.configuration.mean) : Json(nullptr)},
          {"spread", row.configuration.spread
                         ? Json{row.configuration.spread->least, row.configuration.spread->most}
                         : Json(nullptr)},
          {"ratio", row.configuration.ratio.ratio ? Json(*row.configuration.ratio.ratio) : Json(nullptr)},
          {"ratio_interval", row.configuration.ratio.interval ? Json{(*row.configuration.ratio.interval)[0],
                                                                     (*row.configuration.ratio.interval)[1]}
                                                              : Json(nullptr)},
          {"tied", row.configuration.ratio.tied},
          {"n_ok", row.configuration.n_ok},
          {"n_total", row.configuration.n_total},
          {"complete", row.configuration.complete()},
          {"failed", row.configuration.failed},
          {"without_number", row.configuration.without_number},
          {"not_run", row.configuration.not_run}};
}

std::string json(const BestTable& table) {
  Json groups = Json::array();
  for (const BestGroup& group : table.groups) {
    Json rows = Json::array();
    for (const BestRow& row : group.rows) rows.push_back(json_of(row));
    groups.push_back({{"group", group.label},
                      {"data", group.kind},
                      {"recordings", group.recordings},
                      {"headline", group.headline},
                      {"configurations", group.configurations},
                      {"rows", std::move(rows)}});
  }
  const Json document = {{"metric", table.metric->key}, {"unit", table.metric->unit},
                         {"group_by", table.group},     {"options", table.options},
                         {"groups", std::move(groups)}, {"notes", table.notes}};
  return text::json_text(document) + "\n";
}

}  // namespace

Result<BestFormat> parse_best_format(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, BestFormat>, 3> kFormats = {
      {{"markdown", BestFormat::markdown}, {"csv", BestFormat::csv}, {"json", BestFormat::json}}};
  for (const auto& [name, format] : kFormats) {
    if (name == text) return format;
  }
  return fail(ErrorCode::usage, fmt::format("--format {} (allowed: markdown | csv | json)", text));
}

std::string render_best(const BestTable& table, BestFormat format, std::size_t width) {
  switch (format) {
    case BestFormat::markdown:
      return markdown(table, width);
    case BestFormat::csv:
      return csv(table);
    case BestFormat::json:
      return json(table);
  }
  return {};
}

}  // namespace fusebench::aggregate
