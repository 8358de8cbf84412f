#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <vector>

#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/trajectories/plot_options.hpp"
#include "eval/cli/trajectories/trajectory_verbs.hpp"
#include "eval/cli/trajectories/transcript.hpp"
#include "eval/report/evo_results/result_table.hpp"
#include "eval/report/metric_reports/results_plot.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::trajectories {

namespace {

struct ResultOptions {
  std::vector<std::filesystem::path> files;
  evo_results::ResultChoice choice;
  bool relative_time = false;  ///< accepted, and of no effect
  PlotOptions plot;
  std::filesystem::path save_table;
  TranscriptOptions transcript;
  bool json = false;
};

Result<int> run_res(const ResultOptions& options) {
  if (auto csv = check_table_file(options.save_table); !csv) return tl::unexpected(csv.error());
  const auto plots = plot_files(options.plot);
  if (!plots) return tl::unexpected(plots.error());
  Transcript transcript(options.transcript);
  const auto results = evo_results::load_results(options.files, options.choice);
  if (!results) return tl::unexpected(results.error());
  if (!options.save_table.empty()) {
    if (auto written = text::write_text_file(options.save_table, evo_results::to_csv(*results)); !written)
      return tl::unexpected(written.error());
  }
  const auto drawn = draw_all(*plots, transcript, [&](const metric_reports::PlotFile& file) {
    return metric_reports::plot_script(*results, file);
  });
  if (!drawn) return tl::unexpected(drawn.error());
  transcript.result(options.json ? evo_results::to_json(*results)
                                 : evo_results::to_text(*results, !options.choice.ignore_title));
  if (auto logged = transcript.finish(); !logged) return tl::unexpected(logged.error());
  return 0;
}

}  // namespace

console::Verb add_eval_res_verb(CLI::App& eval) {
  auto options = std::make_shared<ResultOptions>();
  CLI::App* verb = eval.add_subcommand(
      "res", "Compares results that --save_results wrote, evo's as well, in a table and a plot (evo_res)");
  verb->add_option("FILES", options->files, "Archives of results")->type_name("")->required();
  verb->add_flag("--use_filenames", options->choice.use_filenames,
                 "Names results by their archives instead of their estimates");
  verb->add_flag("--ignore_title", options->choice.ignore_title,
                 "Puts results side by side whose metrics or alignments differ");
  verb->add_flag("--merge", options->choice.merge,
                 "Makes one result of all: the average of their statistics");
  verb->add_flag("--use_rel_time", options->relative_time,
                 "Accepted for compatibility with evo: times are always relative to the first pose");
  options->plot.usual_file = "res.svg";
  add_plot_options(*verb, options->plot);
  verb->add_option("--save_table", options->save_table, "Writes the table")->type_name("FILE.csv");
  add_transcript_options(*verb, options->transcript, kAlwaysComplete);
  console::add_json_flag(*verb, options->json);
  verb->footer("docs/evo.md lists evo's flags. Exit code 3 for files that are no results.");
  return {verb, [options] { return run_res(*options); }};
}

}  // namespace fusebench::cli::trajectories
