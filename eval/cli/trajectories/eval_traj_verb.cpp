#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "eval/cli/console/number_checks.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/trajectories/bundle_request.hpp"
#include "eval/cli/trajectories/clock_request.hpp"
#include "eval/cli/trajectories/evo_spelling.hpp"
#include "eval/cli/trajectories/loaded_sides.hpp"
#include "eval/cli/trajectories/option_effects.hpp"
#include "eval/cli/trajectories/trajectory_request.hpp"
#include "eval/cli/trajectories/trajectory_verbs.hpp"
#include "eval/report/metric_reports/trajectories_plot.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::trajectories {

namespace {

metric_reports::TrajectoriesPlot plot_of(const Bundle& bundle, const std::string& mode) {
  metric_reports::TrajectoriesPlot plot;
  plot.mode = metric_reports::plot_mode(mode);
  plot.has_stamps = bundle.has_stamps;
  for (const NamedFile& entry : bundle.trajectories)
    plot.trajectories.push_back({entry.trajectory.name, entry.trajectory.poses, false});
  plot.trajectories.back().reference = bundle.has_reference;
  return plot;
}

Result<int> run_traj(const CLI::App& verb, BundleOptions options) {
  if (auto taken = take_leading_format(options.files, options.format); !taken)
    return tl::unexpected(taken.error());
  if (options.files.empty() && options.reference.empty())
    return fail(
        ErrorCode::usage, "no trajectory is given",
        "`fusebench eval traj FILE...`, with an optional format first: tum, kitti, euroc, log or openvins");
  if (auto csv = check_table_file(options.save_table); !csv) return tl::unexpected(csv.error());
  const auto plots = plot_files(options.plot);
  if (!plots) return tl::unexpected(plots.error());
  Transcript transcript(options.transcript);
  const auto bundle = bundle_of(options, transcript);
  if (!bundle) return tl::unexpected(bundle.error());
  OptionContext context{.request = {},
                        .has_stamps = bundle->has_stamps,
                        .associates = options.alignment.asked() || options.sync,
                        .draws = !plots->empty()};
  const auto alignment = aligned_by(options.alignment, {});
  if (!alignment) return tl::unexpected(alignment.error());
  context.request.alignment = *alignment;
  const auto without_effect = warnings_of_effects(verb, context);
  if (!without_effect) return tl::unexpected(without_effect.error());
  transcript.warn(*without_effect);
  std::vector<metric_reports::ListedTrajectory> listed;
  for (const NamedFile& entry : bundle->trajectories) listed.push_back(entry.trajectory);
  if (auto saved = save_bundle(options, *bundle, transcript); !saved) return tl::unexpected(saved.error());
  if (!options.save_table.empty()) {
    if (auto written = text::write_text_file(options.save_table, metric_reports::to_csv(listed)); !written)
      return tl::unexpected(written.error());
  }
  const metric_reports::TrajectoriesPlot plot = plot_of(*bundle, options.plot_mode);
  const auto drawn = draw_all(*plots, transcript, [&](const metric_reports::PlotFile& file) {
    return metric_reports::plot_script(plot, file);
  });
  if (!drawn) return tl::unexpected(drawn.error());
  const auto detail = options.full_check           ? metric_reports::ListingDetail::checks
                      : options.transcript.verbose ? metric_reports::ListingDetail::infos
                                                   : metric_reports::ListingDetail::line;
  transcript.result(options.json ? metric_reports::to_json(listed) : metric_reports::to_text(listed, detail));
  if (auto logged = transcript.finish(); !logged) return tl::unexpected(logged.error());
  return 0;
}

void add_bundle_options(CLI::App& verb, BundleOptions& options) {
  verb.add_option("FILES", options.files,
                  "Trajectories, with an optional format first, as in evo: tum a.txt b.txt")
      ->type_name("");
  verb.add_option("--format", options.format,
                  "Format of all files: tum, kitti, euroc, log or openvins; recognised if not given")
      ->type_name("NAME");
  verb.add_option("--stamp_unit", options.stamp_unit, kStampUnitHelp)->type_name("UNIT[,UNIT]");
  verb.add_option("--ref", options.reference,
                  "The reference; the others are aligned to it, and it is listed last")
      ->type_name("FILE");
  add_alignment_options(verb, options.alignment);
  verb.add_flag("--sync", options.sync, "Keeps only poses with a stamp of the reference");
  verb.add_option("--t_max_diff", options.t_max_diff, "Largest difference of stamps")
      ->check(console::not_negative())
      ->type_name("S")
      ->capture_default_str();
  verb.add_option("--t_offset", options.t_offset, "Added to all stamps but the reference's")
      ->check(console::stamp_range())
      ->type_name("S");
  add_clock_option(
      verb, options.fit_time_offset,
      "Moves the stamps of each by the fitted offset of the reference's clock, and lists it with its "
      "standard deviation and the errors with and without");
  verb.add_option("--downsample", options.downsample, "Downsamples each to N poses first")
      ->check(console::positive())
      ->type_name("N");
  verb.add_option("--motion_filter", options.motion_filter,
                  "Keeps only poses that moved by D metres or turned by A degrees since the last one kept")
      ->expected(2)
      ->check(console::not_negative())
      ->type_name("D A");
  verb.add_option("--project_to_plane", options.plane, "Projects all after the alignment")
      ->check(CLI::IsMember(names_of(kPlanes)))
      ->capture_default_str();
}

void add_bundle_outputs(CLI::App& verb, BundleOptions& options) {
  verb.add_flag("-f,--full_check", options.full_check,
                "Also lists checks of the files, speeds and intervals");
  verb.add_flag("--show_full_names", options.full_names, "Lists files as they are given, not by their stems");
  options.plot.usual_file = "traj.svg";
  add_plot_options(verb, options.plot);
  add_plot_mode_option(verb, options.plot_mode);
  verb.add_flag("--plot_relative_time", options.relative_time,
                "Accepted for compatibility with evo: times are always relative to the first stamp");
  verb.add_option("--save_table", options.save_table, "Writes the numbers of --full_check")
      ->type_name("FILE.csv");
  verb.add_flag("--save_as_tum", options.save_as_tum, "Writes each as NAME.tum into the current folder");
  verb.add_flag("--save_as_kitti", options.save_as_kitti,
                "Writes each as NAME.kitti into the current folder");
  add_transcript_options(verb, options.transcript, "Also lists the ends of each");
  console::add_json_flag(verb, options.json);
}

}  // namespace

console::Verb add_eval_traj_verb(CLI::App& eval) {
  auto options = std::make_shared<BundleOptions>();
  CLI::App* verb =
      eval.add_subcommand("traj", "Lists, draws and converts trajectories: poses, path, duration (evo_traj)");
  add_bundle_options(*verb, *options);
  add_bundle_outputs(*verb, *options);
  verb->footer("docs/evo.md lists evo's flags. Exit code 3 for files that cannot be read or aligned.");
  return {verb, [verb, options] { return run_traj(*verb, *options); }};
}

}  // namespace fusebench::cli::trajectories
