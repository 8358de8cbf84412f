#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/trajectory/trajectory.hpp"
#include "core/base/trajectory/trajectory_extent.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/number_checks.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/trajectories/clock_request.hpp"
#include "eval/cli/trajectories/option_effects.hpp"
#include "eval/cli/trajectories/trajectory_request.hpp"
#include "eval/cli/trajectories/trajectory_verbs.hpp"
#include "eval/metrics/trajectory_files/stamps.hpp"
#include "eval/report/evo_results/result_archive.hpp"
#include "eval/report/metric_reports/trajectory_report.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::trajectories {

namespace {

template <typename T, std::size_t N>
CLI::IsMember members(const std::array<std::pair<const char*, T>, N>& names) {
  return CLI::IsMember(names_of(names));
}

Result<Sides> load(const TrajectoryOptions& options, trajectory_error::Protocol protocol,
                   Transcript& transcript) {
  trajectory_files::TrajectoryReading reading;
  if (!options.format.empty()) {
    const auto parsed = trajectory_files::parse_trajectory_format(options.format);
    if (!parsed) return tl::unexpected(parsed.error());
    reading.format = *parsed;
  }
  const trajectory::Duplicates usual = protocol == trajectory_error::Protocol::evo
                                           ? trajectory::Duplicates::rare_kept
                                           : trajectory::Duplicates::rare_last;
  reading.duplicates = options.duplicates.empty() ? usual : named(kDuplicates, options.duplicates);
  SideReadings readings{reading, reading};
  readings.estimate.tum_without_commas = reading.format == trajectory_files::TrajectoryFormat::euroc;
  if (auto set = set_stamp_units(options.stamp_unit, readings); !set) return tl::unexpected(set.error());
  std::vector<std::string> warnings;
  auto sides = load_sides(options.files[0], options.files[1], readings, warnings);
  transcript.warn(warnings);
  return sides;
}

std::string errors_text(const trajectory_error::ErrorSeries& series) {
  std::string text =
      fmt::format("timestamp_ns,{}{}{}\n", series.relation, series.unit.empty() ? "" : "_", series.unit);
  for (std::size_t i = 0; i < series.errors.size(); ++i)
    text += fmt::format("{},{}\n", series.at_ns[i], series.errors[i]);
  return text;
}

void warn_of_few(const trajectory_error::TrajectoryEvaluation& evaluation, Transcript& transcript) {
  constexpr double kFew = 0.5;
  if (evaluation.coverage >= kFew) return;
  transcript.warn({fmt::format(
      "only {} of {} possible pairs were compared ({:.1f} %): the numbers do not describe the rest",
      evaluation.pairs, evaluation.possible, 100 * evaluation.coverage)});
}

/// evo aligns these without a word; the numbers are those of noise or of another unit.
void warn_of_extents(const Sides& sides, const trajectory_error::TrajectoryEvaluation& evaluation,
                     Transcript& transcript) {
  constexpr double kMostFactor = 100;
  const Trajectory moved = trajectory::with_clock_offset(
      sides.estimate.poses, trajectory_files::nanoseconds(evaluation.request.association.offset_s));
  const Trajectory reference = trajectory::within_time_of(sides.reference.poses, moved);
  const Trajectory estimate = trajectory::within_time_of(moved, sides.reference.poses);
  if (reference.empty() || estimate.empty()) return;
  const double reference_m = trajectory::extent_m(reference);
  const double estimate_m = trajectory::extent_m(estimate);
  const double scale = evaluation.alignment.scale;
  const bool scaled = scale > kMostFactor || scale * kMostFactor < 1;
  const bool unlike = reference_m > kMostFactor * estimate_m || estimate_m > kMostFactor * reference_m;
  if (!scaled && !unlike) return;
  transcript.warn({fmt::format(
      "the reference extends over {:.3g} m and the estimate over {:.3g} m{}: does one "
      "of them not move, or is it in another unit?",
      reference_m, estimate_m, scaled ? fmt::format(" (scale of the alignment {:.3g})", scale) : "")});
}

void warn_of_poses_with_themselves(const trajectory_error::TrajectoryEvaluation& evaluation,
                                   Transcript& transcript) {
  if (evaluation.with_itself == 0) return;
  transcript.warn({fmt::format(
      "poses without a pose a delta later (gaps longer than twice the delta): {}; evaluate_rpe.py "
      "pairs them with themselves and counts the error 0, they are left out here",
      evaluation.with_itself)});
}

Result<void> change_units(trajectory_error::TrajectoryEvaluation& evaluation, const std::string& wanted) {
  if (wanted.empty()) return {};
  const std::string unit = evaluation.series.front().unit;
  for (trajectory_error::ErrorSeries& series : evaluation.series) {
    if (series.unit != unit) continue;
    if (auto converted = trajectory_error::change_unit(series, wanted); !converted) return converted;
  }
  return {};
}

Result<void> write_files(const TrajectoryOptions& options, const Sides& sides,
                         const trajectory_error::TrajectoryEvaluation& evaluation,
                         const std::vector<metric_reports::PlotFile>& plots, Transcript& transcript) {
  const trajectory_error::ErrorSeries& series = evaluation.series.front();
  if (!options.errors.empty()) {
    if (auto written = text::write_text_file(options.errors, errors_text(series)); !written) return written;
  }
  if (options.save_results.empty() && plots.empty()) return {};
  const evo_results::EvoResult result =
      evo_results::result_of(evaluation, {options.files[0], options.files[1], sides.have_stamps()});
  if (!options.save_results.empty()) {
    const auto archive = evo_results::archive_of(result);
    if (!archive) return tl::unexpected(archive.error());
    if (auto written = text::write_text_file(options.save_results, *archive); !written) return written;
  }
  const ErrorPlotOptions& drawn = options.error_plot;
  const metric_reports::ErrorPlot plot{
      result,
      drawn.full_reference ? sides.reference.poses : evaluation.compared.reference,
      evaluation.compared.estimate,
      series.at,
      metric_reports::plot_mode(drawn.mode),
      named(kAbscissae, drawn.abscissa),
      drawn.colour_min,
      drawn.colour_max,
      drawn.colour_max_percentile};
  return draw_all(plots, transcript, [&](const metric_reports::PlotFile& file) {
    return metric_reports::plot_script(plot, file);
  });
}

Result<int> run(const CLI::App& verb, TrajectoryOptions options, trajectory_error::TrajectoryMetric metric) {
  if (auto taken = take_two_files(options); !taken) return tl::unexpected(taken.error());
  std::vector<std::string> warnings;
  auto request = request_of(options, metric, warnings);
  if (!request) return tl::unexpected(request.error());
  const auto plots = plot_files(options.plot);
  if (!plots) return tl::unexpected(plots.error());
  Transcript transcript(options.transcript);
  transcript.warn(warnings);
  const auto sides = load(options, request->protocol, transcript);
  if (!sides) return tl::unexpected(sides.error());
  if (auto suited = suit_stamps(*sides, *request); !suited) return tl::unexpected(suited.error());
  const auto without_effect =
      warnings_of_effects(verb, {.request = *request,
                                 .has_stamps = sides->have_stamps(),
                                 .draws = !plots->empty(),
                                 .draws_over_distance = options.error_plot.abscissa == "distances"});
  if (!without_effect) return tl::unexpected(without_effect.error());
  transcript.warn(*without_effect);
  auto evaluation = trajectory_error::evaluate(sides->reference.poses, sides->estimate.poses, *request);
  if (!evaluation) return tl::unexpected(evaluation.error());
  std::optional<reference_clock::ReferenceClock> clock;
  if (options.fit_time_offset) {
    const auto fitted = fit_clock(*sides, *request, *evaluation);
    if (!fitted) return tl::unexpected(fitted.error());
    clock = *fitted;
  }
  if (auto changed = change_units(*evaluation, options.change_unit); !changed)
    return tl::unexpected(changed.error());
  warn_of_few(*evaluation, transcript);
  warn_of_poses_with_themselves(*evaluation, transcript);
  warn_of_extents(*sides, *evaluation, transcript);
  if (auto written = write_files(options, *sides, *evaluation, *plots, transcript); !written)
    return tl::unexpected(written.error());
  const metric_reports::ComparedFiles files = compared_files(options.files[0], options.files[1], *sides);
  const auto each =
      options.all_errors ? metric_reports::EachError::listed : metric_reports::EachError::left_out;
  transcript.result(options.json ? metric_reports::to_json(*evaluation, files, each, clock)
                                 : metric_reports::to_text(*evaluation, files, clock));
  if (auto logged = transcript.finish(); !logged) return tl::unexpected(logged.error());
  return 0;
}

void add_protocol_options(CLI::App& verb, TrajectoryOptions& options) {
  verb.add_option("GT EST", options.files,
                  "Reference and estimate, with an optional format first, as in evo: tum ref.txt est.txt")
      ->type_name("");
  verb.add_option("--format", options.format,
                  "Format of both files: tum, kitti, euroc, log or openvins; recognised if not given")
      ->type_name("NAME");
  verb.add_option("--stamp_unit", options.stamp_unit, kStampUnitHelp)->type_name("UNIT[,UNIT]");
  verb.add_option("--protocol", options.protocol,
                  "evo, tum, rpg, eth3d or kitti: sets the defaults of the options below")
      ->type_name("NAME")
      ->capture_default_str();
  add_alignment_options(verb, options.alignment);
  verb.add_option("--t_max_diff", options.t_max_diff,
                  "Largest difference of stamps (evo 0.01, tum and rpg 0.02), or gap to interpolate")
      ->check(console::not_negative())
      ->type_name("S");
  verb.add_option("--t_offset", options.t_offset, "Added to the estimate's stamps")
      ->check(console::stamp_range())
      ->type_name("S");
  verb.add_option("--t_start", options.t_start, "Uses the reference from this stamp on")
      ->check(console::stamp_range())
      ->type_name("S");
  verb.add_option("--t_end", options.t_end, "Uses the reference up to this stamp")
      ->check(console::stamp_range())
      ->type_name("S");
  verb.add_flag("--interpolate", options.interpolate,
                "Interpolates the reference at the estimate's stamps, in gaps of up to --t_max_diff (0.1 s)");
  verb.add_option("--images", options.images,
                  "With --protocol eth3d: list whose stamps are compared (rgb.txt); default: the reference's")
      ->type_name("FILE");
  verb.add_option("--duplicates", options.duplicates,
                  "Rows of one stamp: error, first, last or keep (both). Default: as the protocol's script "
                  "does, while they are rare")
      ->check(members(kDuplicates));
}

void add_selection_options(CLI::App& verb, TrajectoryOptions& options) {
  verb.add_option("--downsample", options.downsample, "Downsamples each side to N poses first")
      ->check(console::positive())
      ->type_name("N");
  verb.add_option("--motion_filter", options.motion_filter,
                  "Keeps only poses that moved by D metres or turned by A degrees since the last one kept")
      ->expected(2)
      ->check(console::not_negative())
      ->type_name("D A");
  verb.add_option("--project_to_plane", options.plane, "Projects both sides after the alignment")
      ->check(members(kPlanes))
      ->capture_default_str();
  verb.add_option("-r,--pose_relation", options.relation,
                  "trans_part, rot_part, angle_deg, angle_rad, full, point_distance, or of rpe "
                  "point_distance_error_ratio")
      ->type_name("NAME")
      ->capture_default_str();
  verb.add_option("--change_unit", options.change_unit, "mm, cm, km, rad or deg")->type_name("UNIT");
}

void add_offset_option(CLI::App& verb, TrajectoryOptions& options) {
  verb.add_flag("--fit_offset", options.fit_offset,
                "Also computes the error after SE3 alignment with a fitted offset between camera and "
                "motion-capture body, with its standard deviations");
}

void add_motion_options(CLI::App& verb, TrajectoryOptions& options) {
  verb.add_option("-d,--delta", options.delta,
                  "Interval between the poses of a pair; default: 1 frame (evo), 1 s (tum)")
      ->type_name("D");
  verb.add_option("-u,--delta_unit", options.delta_unit, "f (frames), m, d (degrees), r (radians) or s")
      ->type_name("UNIT");
  verb.add_option("-t,--delta_tol", options.delta_tol, "Tolerance of --all_pairs, as a share of delta")
      ->check(console::not_negative())
      ->capture_default_str();
  verb.add_flag("--all_pairs", options.all_pairs,
                "Uses all pairs: from every pose; with --protocol tum, also to every pose");
  verb.add_flag("--pairs_from_reference", options.pairs_from_reference,
                "Selects pairs by the motion of the reference instead of the estimate");
}

void add_error_plot_options(CLI::App& verb, ErrorPlotOptions& options) {
  add_plot_mode_option(verb, options.mode);
  verb.add_option("--plot_x_dimension", options.abscissa,
                  "Of the plot of errors: seconds, index or distances")
      ->type_name("NAME")
      ->check(members(kAbscissae))
      ->capture_default_str();
  verb.add_option("--plot_colormap_min", options.colour_min, "Error of the first colour; default: the least")
      ->type_name("E");
  auto* largest = verb.add_option("--plot_colormap_max", options.colour_max,
                                  "Error of the last colour; default: the largest")
                      ->type_name("E");
  verb.add_option("--plot_colormap_max_percentile", options.colour_max_percentile,
                  "Percentile of the errors for the last colour, in place of --plot_colormap_max")
      ->check(console::number_range(0.0, 100.0))
      ->excludes(largest)
      ->type_name("P");
  verb.add_flag("--plot_full_ref", options.full_reference,
                "Draws the whole reference instead of the compared part");
}

console::Verb add(CLI::App& eval, trajectory_error::TrajectoryMetric metric, const char* description) {
  auto options = std::make_shared<TrajectoryOptions>();
  CLI::App* verb = eval.add_subcommand(std::string(trajectory_error::to_string(metric)), description);
  add_protocol_options(*verb, *options);
  add_selection_options(*verb, *options);
  if (metric == trajectory_error::TrajectoryMetric::rpe)
    add_motion_options(*verb, *options);
  else
    add_offset_option(*verb, *options);
  add_clock_option(*verb, options->fit_time_offset,
                   "Also computes the errors with a fitted offset of the reference's clock (after "
                   "--t_offset), with its standard deviation");
  options->plot.usual_file = metric == trajectory_error::TrajectoryMetric::ate ? "ape.svg" : "rpe.svg";
  add_plot_options(*verb, options->plot);
  add_error_plot_options(*verb, options->error_plot);
  verb->add_option("--save_results", options->save_results,
                   "Writes errors, statistics and poses as evo does, for `fusebench eval res` and evo_res")
      ->type_name("FILE.zip");
  verb->add_option("--errors", options->errors, "Writes each error with its stamp")->type_name("FILE.csv");
  add_transcript_options(*verb, options->transcript, kAlwaysComplete);
  console::add_json_flag(*verb, options->json);
  verb->add_flag("--all_errors", options->all_errors, "With --json: also lists each error with its stamp");
  verb->footer(
      "docs/metrics.md defines the protocols, docs/evo.md lists evo's flags. Exit code 3 for files that "
      "cannot be compared.");
  return {verb, [verb, options, metric] { return run(*verb, *options, metric); }};
}

}  // namespace

console::Verb add_eval_ate_verb(CLI::App& eval) {
  return add(eval, trajectory_error::TrajectoryMetric::ate,
             "Computes the absolute trajectory error (evo_ape, evaluate_ate.py); `eval ape` is the same");
}

console::Verb add_eval_rpe_verb(CLI::App& eval) {
  return add(
      eval, trajectory_error::TrajectoryMetric::rpe,
      "Computes the relative pose error (evo_rpe, evaluate_rpe.py), or that of segments (rpg, eth3d, kitti)");
}

}  // namespace fusebench::cli::trajectories
