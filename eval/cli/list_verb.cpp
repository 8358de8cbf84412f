#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/all_systems.hpp"
#include "core/base/nearest_name.hpp"
#include "core/config/config_access.hpp"
#include "core/config/variants.hpp"
#include "datasets/calibration/recording_catalogue.hpp"
#include "datasets/open_recording.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/console/table_width.hpp"
#include "eval/cli/verbs.hpp"
#include "eval/record/registry/run_metric.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/run_set.hpp"
#include "eval/suites/engine/run_housekeeping.hpp"
#include "eval/suites/recording_names.hpp"
#include "eval/suites/suite_file.hpp"
#include "eval/suites/suite_names.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::cli {

namespace {

/// Values that are not given are an empty text.
using Cell = std::optional<std::string>;

/// A list as rows under named columns; every way of printing it starts from here.
struct Listing {
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
};

struct ListOptions {
  std::string what;
  std::string of;  ///< the folder of runs, or a text that rows contain
  std::string status;
  bool verify = false;
  std::filesystem::path data;
  std::filesystem::path configs;
  bool markdown = false;
  bool json = false;
  std::optional<std::size_t> width;
};

Listing list_variants() {
  Listing listing{{"variant", "paper", "edits", "meaning"}, {}};
  for (const config::Variant& variant : config::all_variants()) {
    const std::string edits = variant.base.empty() ? std::string(variant.edits)
                                                   : fmt::format("{} and {}", variant.base, variant.edits);
    listing.rows.push_back(
        {std::string(variant.name), std::string(variant.paper_label), edits, std::string(variant.sentence)});
  }
  return listing;
}

Listing list_systems() {
  Listing listing{{"system", "option", "groups of options", "threads", "meaning"}, {}};
  for (const core::SystemRow& row : core::all_systems()) {
    listing.rows.push_back({std::string(row.name), fmt::format("system.method={}", row.name),
                            std::string(row.options), std::string(row.threads), std::string(row.sentence)});
  }
  return listing;
}

/// Nothing where there is no text.
Cell word_cell(std::string_view text) { return text.empty() ? Cell() : Cell(text); }

/// The tables in which a metric is a column: "runs systems".
std::string tables_of(const registry::RunMetric& metric) {
  using enum registry::Column;
  std::string text;
  for (const auto& [column, name] :
       {std::pair(runs, "runs"), std::pair(systems, "systems"), std::pair(study, "study")}) {
    if (metric.is_column_of(column)) text += fmt::format("{}{}", text.empty() ? "" : " ", name);
  }
  return text;
}

Listing list_metrics() {
  Listing listing{{"metric", "word", "unit", "better", "tables", "record", "definition"}, {}};
  for (const registry::RunMetric& metric : registry::run_metrics()) {
    const std::string_view better =
        metric.better == registry::Better::neither ? "neither" : registry::to_string(metric.better);
    listing.rows.push_back({std::string(metric.key), word_cell(metric.word), std::string(metric.unit),
                            std::string(better), word_cell(tables_of(metric)), word_cell(metric.path),
                            std::string(metric.definition)});
  }
  return listing;
}

Listing list_options() {
  Listing listing{{"option", "type", "default", "range", "meaning"}, {}};
  for (const config::OptionRow& row : config::describe_options(config::EffectiveConfig{}.values())) {
    listing.rows.push_back({row.key, row.type, row.value, row.range, row.sentence});
  }
  return listing;
}

/// Published recordings, present or not, and then what else is under `data` (may be empty).
Result<Listing> list_recordings(const std::filesystem::path& data) {
  Listing listing{{"recording", "format", "frames", "licence", "folder", "title"}, {}};
  std::vector<std::filesystem::path> others;
  if (std::error_code error; std::filesystem::exists(data, error)) {
    // An empty folder is no error here: the catalogue is worth printing.
    if (auto found = suites::recordings_under(data)) others = std::move(*found);
  } else if (!data.empty()) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no such folder", data.string()),
                "--data or FUSEBENCH_DATA names the folder of recordings");
  }
  for (const calibration::CatalogueEntry& entry : calibration::recording_catalogue()) {
    const auto folder = calibration::catalogue_folder(entry, data);
    if (folder) std::erase(others, *folder);
    const auto frames = entry.frames ? entry.frames : entry.color_images;
    listing.rows.push_back({entry.name, entry.format, frames ? Cell(std::to_string(*frames)) : std::nullopt,
                            entry.licence, folder ? Cell(folder->string()) : std::nullopt, entry.title});
  }
  for (const auto& folder : others) {
    listing.rows.push_back({folder.filename().string(),
                            std::string(datasets::recognise_format(folder).value_or("")), std::nullopt,
                            std::nullopt, folder.string(), std::nullopt});
  }
  return listing;
}

/// The names, or how many there are where simulations are multiplied out.
std::string recordings_of(const suites::Suite& suite) {
  std::string text = suite.all ? "all" : "";
  for (const suites::SuiteRecording& recording : suite.recordings)
    text += fmt::format("{}{}", text.empty() ? "" : " ", recording.name);
  if (suite.simulations.empty()) return text;
  return fmt::format("{}{}{} simulated", text, text.empty() ? "" : " ", suite.simulations.size());
}

/// The variants, then the files that define external programs (which need not be there).
std::string systems_of(const suites::Suite& suite) {
  std::string text = fmt::format("{}", fmt::join(suite.variants, " "));
  for (const std::string& file : suite.systems) text += fmt::format(" {}", file);
  return text;
}

Result<Listing> list_suites(const std::filesystem::path& configs) {
  const auto files = suites::suite_files(configs.empty() ? suites::shipped_configs() : configs);
  if (!files) return tl::unexpected(files.error());
  Listing listing{{"suite", "file", "variants", "recordings"}, {}};
  for (const auto& file : *files) {
    const auto suite = suites::read_suite(file);
    if (!suite) return tl::unexpected(suite.error());
    listing.rows.push_back({suite->name, file.string(), systems_of(*suite), recordings_of(*suite)});
  }
  return listing;
}

Result<Listing> list_runs_of(const ListOptions& options) {
  const std::filesystem::path folder = options.of.empty() ? "results/runs" : options.of;
  const auto runs = engine::list_runs(folder, options.verify);
  if (!runs) return tl::unexpected(runs.error());
  if (runs->empty()) return run_files::holds_no_runs(folder);
  std::vector<run_files::RunIdentity> identities;
  for (const engine::ListedRun& run : *runs) identities.push_back(run.identity);
  const std::vector<std::string> labels = run_files::RunSet(std::move(identities)).labels();
  Listing listing{{"run", "label", "status", "reason"}, {}};
  for (std::size_t i = 0; i < runs->size(); ++i) {
    const engine::ListedRun& run = (*runs)[i];
    const std::string_view status = record::to_string(run.head.status);
    if (!options.status.empty() && options.status != status) continue;
    listing.rows.push_back({(folder / run.folder).string(), labels[i], std::string(status), run.head.reason});
  }
  return listing;
}

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

/// Leaves the rows of which a cell contains the text, whatever its case.
Result<void> filter(Listing& listing, const std::string& what, const std::string& text) {
  if (text.empty()) return {};
  std::vector<std::string> names;
  for (const auto& row : listing.rows) names.push_back(row.front().value_or(""));
  std::erase_if(listing.rows, [&, wanted = lower(text)](const std::vector<Cell>& row) {
    return std::ranges::none_of(
        row, [&](const Cell& cell) { return lower(cell.value_or("")).find(wanted) != std::string::npos; });
  });
  if (!listing.rows.empty()) return {};
  return fail(ErrorCode::usage, fmt::format("none of the {} {} contains '{}'{}", names.size(), what, text,
                                            nearest_hint(text, names)));
}

Result<Listing> whole_listing(const ListOptions& options) {
  if (options.what == "variants") return list_variants();
  if (options.what == "systems") return list_systems();
  if (options.what == "metrics") return list_metrics();
  if (options.what == "options") return list_options();
  if (options.what == "suites") return list_suites(options.configs);
  return list_recordings(options.data);
}

Result<Listing> listing_of(const ListOptions& options) {
  if (options.what == "runs") return list_runs_of(options);
  auto listing = whole_listing(options);
  if (!listing) return listing;
  if (auto left = filter(*listing, options.what, options.of); !left) return tl::unexpected(left.error());
  return listing;
}

std::string markdown_of(const std::string& what, const Listing& listing) {
  std::string title = what;
  title[0] = static_cast<char>(title[0] - 'a' + 'A');
  std::string text = fmt::format(
      "# {}\n\n<!-- generated by scripts/generate_docs.sh from `fusebench list {} --markdown` -->\n\n|",
      title, what);
  for (const std::string& column : listing.columns) text += fmt::format(" {} |", column);
  text += "\n|";
  for (std::size_t i = 0; i < listing.columns.size(); ++i) text += " --- |";
  text += "\n";
  for (const auto& row : listing.rows) {
    text += "|";
    for (const Cell& cell : row) text += fmt::format(" {} |", text::markdown_cell(cell.value_or("-")));
    text += "\n";
  }
  return text;
}

std::string json_of(const std::string& what, const Listing& listing) {
  using Json = nlohmann::ordered_json;
  Json rows = Json::array();
  for (const auto& row : listing.rows) {
    Json entry = Json::object();
    for (std::size_t i = 0; i < row.size(); ++i)
      entry[listing.columns[i]] = row[i] ? Json(*row[i]) : Json(nullptr);
    rows.push_back(entry);
  }
  return text::json_text(Json{{what, rows}}) + "\n";
}

Result<int> list(const ListOptions& options) {
  const auto listing = listing_of(options);
  if (!listing) return tl::unexpected(listing.error());
  if (options.json) {
    console::print_output(json_of(options.what, *listing));
  } else if (options.markdown) {
    console::print_output(markdown_of(options.what, *listing));
  } else {
    std::vector<std::vector<std::string>> lines = {listing->columns};
    for (const auto& row : listing->rows) {
      lines.emplace_back();
      for (const Cell& cell : row) lines.back().push_back(cell.value_or("-"));
    }
    console::print_output(text::fitted_columns(lines, console::table_width(options.width)));
  }
  return 0;
}

}  // namespace

console::Verb add_list_verb(CLI::App& app) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* verb =
      app.add_subcommand("list", "Lists variants, systems, metrics, recordings, suites, options or runs");
  verb->add_option("WHAT", options->what, "variants, systems, metrics, recordings, suites, options or runs")
      ->required()
      ->check(CLI::IsMember({"variants", "systems", "metrics", "recordings", "suites", "options", "runs"}));
  verb->add_option("OF", options->of,
                   "With runs: their folder [results/runs]; otherwise a text: only rows that contain it")
      ->type_name("FOLDER|TEXT");
  verb->add_option("-o,--only", options->status, "With runs: only runs with this status: ok, lost or failed")
      ->check(CLI::IsMember({"ok", "lost", "failed"}))
      ->type_name("STATUS");
  verb->add_flag("--verify", options->verify,
                 "With runs: compares the contents of every file with its fingerprint; otherwise only sizes");
  console::add_data_option(*verb, options->data);
  verb->add_option("--configs", options->configs,
                   "Folder that holds suites/; default: configs here, above here or above the program")
      ->type_name("DIR");
  verb->add_flag("--markdown", options->markdown, "Prints a page of the documentation");
  console::add_json_flag(*verb, options->json);
  console::add_width_option(*verb, options->width);
  return {verb, [options] { return list(*options); }};
}

}  // namespace fusebench::cli
