#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <string_view>

#include "datasets/images/image_files.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/results/recorded_frames.hpp"
#include "eval/cli/results/result_verbs.hpp"
#include "eval/compare/aggregate/run_rows.hpp"
#include "eval/page/figures.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/report/results_page.hpp"
#include "eval/report/sweep_sections.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::results {

namespace {

struct ReportOptions {
  std::filesystem::path runs;
  std::filesystem::path out;
  std::filesystem::path data;
  std::string title;
  std::filesystem::path figures;
  std::string figure_format = "svg";
};

/// As PAGE-RUN.png in the folder of the page; PAGE-RUN-2.png where runs have names alike.
report::PictureWriter pictures_beside(const std::filesystem::path& page) {
  return [page, names = std::set<std::string>()](const std::string& run,
                                                 const ColorImage& picture) mutable -> Result<std::string> {
    const std::string stem = fmt::format("{}-{}", page::file_name_of(page.stem().string()), run);
    std::string name = stem + ".png";
    for (int copy = 2; !names.insert(name).second; ++copy) name = fmt::format("{}-{}.png", stem, copy);
    const auto png = images::encode_png(picture);
    if (!png) return tl::unexpected(png.error());
    const std::string_view bytes(reinterpret_cast<const char*>(png->data()), png->size());
    return text::write_text_file(page.parent_path() / name, bytes).map([&] { return name; });
  };
}

Result<int> report(const ReportOptions& options) {
  console::Progress progress(fmt::format("reading {}", options.runs.string()));
  const auto runs = run_files::find_runs(options.runs);
  if (!runs) return tl::unexpected(runs.error());
  std::string title = options.title;
  if (title.empty())
    title = "Results of " + std::filesystem::weakly_canonical(options.runs).filename().string();
  progress.say(fmt::format("report of {} runs", runs->size()));
  report::ResultsPage page = report::results_page(*runs, title, recorded_frames(options.data, options.runs),
                                                  pictures_beside(options.out));
  const auto rows = aggregate::read_run_rows(options.runs, Workers(1));
  if (!rows) return tl::unexpected(rows.error());
  auto sweep = report::sweep_sections(*rows);
  const auto after_tables = page.page.sections.begin() + static_cast<std::ptrdiff_t>(page.tables);
  page.page.sections.insert(after_tables, std::make_move_iterator(sweep.begin()),
                            std::make_move_iterator(sweep.end()));
  console::print_warnings(page.warnings);
  const std::string html = page::to_html(page.page);
  if (auto written = text::write_text_file(options.out, html); !written)
    return tl::unexpected(written.error());
  console::print_progress(fmt::format("{}: {} run{}, {:.1f} MB", options.out.string(), runs->size(),
                                      runs->size() == 1 ? "" : "s", static_cast<double>(html.size()) / 1e6));
  if (options.figures.empty()) return 0;
  const auto format = page::parse_figure_format(options.figure_format);
  if (!format) return tl::unexpected(format.error());
  progress.say("drawing figures");
  const auto figures = page::write_figures(page.page, options.figures, *format);
  if (!figures) return tl::unexpected(figures.error());
  console::print_progress(fmt::format("{}: {} figures", options.figures.string(), *figures));
  return 0;
}

}  // namespace

console::Verb add_report_verb(CLI::App& app) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* verb = app.add_subcommand(
      "report", "Writes a self-contained HTML page of a folder of runs: tables, charts, patches and meshes");
  verb->add_option("RUNS", options->runs, "Folder that holds runs at any depth")->required();
  verb->add_option("--out", options->out, "The page to write")->type_name("FILE.html")->required();
  console::add_data_option(*verb, options->data);
  verb->add_option("--title", options->title, "Heading of the page; default: the folder's name")
      ->type_name("TEXT");
  auto* figures =
      verb->add_option("--figures", options->figures,
                       "Also writes every chart as a file for papers, with the gnuplot script that draws it")
          ->type_name("DIR");
  verb->add_option("--figure-format", options->figure_format, "svg or pdf")
      ->check(CLI::IsMember({"svg", "pdf"}))
      ->needs(figures)
      ->capture_default_str();
  return {verb, [options] { return report(*options); }};
}

}  // namespace fusebench::cli::results
