#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/number_checks.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/evaluation/eval_verbs.hpp"
#include "eval/cli/trajectories/loaded_sides.hpp"
#include "eval/metrics/trajectory_error/pose_nees.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "eval/page/figures.hpp"
#include "eval/report/metric_reports/nees_report.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::evaluation {

namespace {

constexpr double kUsualGap_s = 0.1;

struct NeesOptions {
  std::string reference;
  std::string estimate;
  std::string align = "se3";
  /// A nearest stamp half an interval away is an error of its own, larger than what a covariance speaks of.
  trajectory_files::AssociationOptions association{trajectory_files::AssociationRule::interpolated,
                                                   kUsualGap_s};
  std::filesystem::path errors;
  std::filesystem::path figures;
  std::string figure_format = "svg";
  bool json = false;
};

constexpr std::array<std::pair<const char*, trajectory_error::AlignmentMode>, 4> kNeesAlignments{
    {{"none", trajectory_error::AlignmentMode::none},
     {"se3", trajectory_error::AlignmentMode::se3},
     {"yaw", trajectory_error::AlignmentMode::yaw},
     {"origin", trajectory_error::AlignmentMode::origin}}};

trajectory_error::AlignmentMode alignment_named(const std::string& name) {
  for (const auto& [known, mode] : kNeesAlignments) {
    if (name == known) return mode;
  }
  return trajectory_error::AlignmentMode::se3;  // the parser lets no other name through
}

Result<void> write_files(const NeesOptions& options, const trajectory_error::PoseConsistency& consistency) {
  if (!options.errors.empty()) {
    if (auto written = text::write_text_file(options.errors, metric_reports::consistency_csv(consistency));
        !written)
      return written;
  }
  if (options.figures.empty()) return {};
  const auto format = page::parse_figure_format(options.figure_format);
  if (!format) return tl::unexpected(format.error());
  page::Page page;
  page.sections.push_back({"nees", "", metric_reports::consistency_charts(consistency)});
  const auto drawn = page::write_figures(page, options.figures, *format);
  if (!drawn) return tl::unexpected(drawn.error());
  console::print_progress(fmt::format("{}: {} figures", options.figures.string(), *drawn));
  return {};
}

Result<int> run(const NeesOptions& options) {
  const auto sides = trajectories::load_sides(options.reference, options.estimate);
  if (!sides) return tl::unexpected(sides.error());
  if (!sides->reference.has_stamps())
    return fail(ErrorCode::usage, "the reference has no stamps (kitti)", "use a TUM or EuRoC file");
  metric_reports::ConsistencyQuestion question;
  question.files = trajectories::compared_files(options.reference, options.estimate, *sides);
  question.association = options.association;
  question.alignment.mode = alignment_named(options.align);
  const auto consistency = trajectory_error::pose_consistency(sides->reference.poses, sides->estimate,
                                                              question.association, question.alignment);
  if (!consistency) return tl::unexpected(consistency.error());
  if (auto written = write_files(options, *consistency); !written) return tl::unexpected(written.error());
  console::print_output(options.json ? metric_reports::to_json(*consistency, question)
                                     : metric_reports::to_text(*consistency, question));
  return 0;
}

}  // namespace

console::Verb add_eval_nees_verb(CLI::App& eval) {
  auto options = std::make_shared<NeesOptions>();
  CLI::App* verb = eval.add_subcommand(
      "nees", "Evaluates the consistency of an estimate with covariances: NEES and 3 sigma bounds (ov_eval)");
  verb->add_option("GT", options->reference, "Reference, TUM or EuRoC")->required();
  verb->add_option("EST", options->estimate,
                   "Estimate in ov_eval's format: timestamp, position, quaternion, upper triangles of the "
                   "covariances of orientation (body) and position (world); 20 columns")
      ->required();
  std::vector<std::string> modes;
  for (const auto& [name, mode] : kNeesAlignments) modes.emplace_back(name);
  verb->add_option("--align", options->align,
                   "Alignment of the estimate: none, se3, yaw (and position), or origin (the first pair); an "
                   "alignment reduces the errors")
      ->type_name("MODE")
      ->check(CLI::IsMember(modes))
      ->capture_default_str();
  verb->add_option("--t_max_diff", options->association.max_difference_s,
                   "The reference is interpolated at the estimate's stamps in gaps up to this")
      ->check(console::not_negative())
      ->type_name("S")
      ->capture_default_str();
  verb->add_option("--t_offset", options->association.offset_s, "Added to the estimate's stamps")
      ->check(console::stamp_range())
      ->type_name("S")
      ->capture_default_str();
  verb->add_option("--errors", options->errors, "Writes errors, sigmas and NEES of each pose")
      ->type_name("FILE.csv");
  auto* figures = verb->add_option("--figures", options->figures,
                                   "Draws errors against 3 sigma by axis, and NEES over time (gnuplot)")
                      ->type_name("DIR");
  verb->add_option("--figure-format", options->figure_format, "svg or pdf")
      ->check(CLI::IsMember({"svg", "pdf"}))
      ->needs(figures)
      ->capture_default_str();
  console::add_json_flag(*verb, options->json);
  verb->footer("docs/metrics.md defines the numbers. Exit code 3 for files that cannot be compared.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench::cli::evaluation
