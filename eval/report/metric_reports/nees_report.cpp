#include "eval/report/metric_reports/nees_report.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "core/base/geometry.hpp"
#include "eval/metrics/nees_metrics.hpp"
#include "eval/metrics/statistics_json.hpp"
#include "eval/metrics/trajectory_error/alignment_json.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::metric_reports {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
constexpr double kCentimetres = 100;
constexpr std::size_t kBuckets = 450;

std::string number(double value) { return fmt::format("{:.4g}", value); }

std::string shares(const Vector3d& share) {
  return fmt::format("{:.1f} / {:.1f} / {:.1f} %", 100 * share.x(), 100 * share.y(), 100 * share.z());
}

double coverage_of(const trajectory_error::PoseConsistency& c) {
  return c.possible == 0 ? 0.0 : static_cast<double>(c.pairs) / static_cast<double>(c.possible);
}

std::vector<std::vector<std::string>> heading(const trajectory_error::PoseConsistency& c,
                                              const ConsistencyQuestion& question) {
  const ComparedFiles& files = question.files;
  const SE3& rigid = c.T_reference_estimate.rigid;
  return {
      {"reference",
       fmt::format("{} ({})", files.reference, trajectory_files::to_string(files.reference_format))},
      {"estimate",
       fmt::format("{} ({})", files.estimate, trajectory_files::to_string(files.estimate_format))},
      {"association", fmt::format("reference interpolated in gaps of at most {:.6g} s",
                                  question.association.max_difference_s)},
      {"pairs", fmt::format("{} of {} possible (coverage {:.1f} %), {} without NEES (singular covariance)",
                            c.pairs, c.possible, 100 * coverage_of(c), c.singular)},
      {"alignment", fmt::format("{}: rotated by {:.4f} deg, translated by {:.4f} m; the ground truth is "
                                "transformed by its inverse into the frame of the covariances",
                                trajectory_error::to_string(question.alignment.mode),
                                degrees(so3_log(rigid.rotation).norm()), rigid.translation.norm())}};
}

Json json_of_part(const trajectory_error::PartConsistency& part, const char* unit) {
  const Vector3d& share = part.share_within_3_sigma;
  return {{"nees_per_dof", metrics::json_of(part.nees)},
          {"unit", unit},
          {"error_rmse", part.error_rmse},
          {"sigma_rms", part.sigma_rms},
          {"share_within_3_sigma", {share.x(), share.y(), share.z()}}};
}

page::Chart error_chart(const trajectory_error::PoseConsistency& c, int axis, const char* what,
                        const char* unit, double factor,
                        Vector3d trajectory_error::PoseConsistencyRow::*error,
                        Vector3d trajectory_error::PoseConsistencyRow::*sigma) {
  page::Chart chart;
  chart.title = fmt::format("{} error along {}", what, kAxes[static_cast<std::size_t>(axis)]);
  chart.x_label = "time [s]";
  chart.left_label = fmt::format("error [{}]", unit);
  chart.from_zero = false;
  std::vector<Vector2d> errors;
  std::vector<Vector2d> upper;
  std::vector<Vector2d> lower;
  for (const trajectory_error::PoseConsistencyRow& row : c.rows) {
    const double time_s = seconds_between(c.rows.front().timestamp_ns, row.timestamp_ns);
    const double bound = 3 * factor * (row.*sigma)[axis];
    errors.emplace_back(time_s, factor * (row.*error)[axis]);
    upper.emplace_back(time_s, bound);
    lower.emplace_back(time_s, -bound);
  }
  chart.series.push_back({"error", page::thinned(errors, kBuckets), page::SeriesStyle::line, false, 1});
  chart.series.push_back({"3 sigma", page::thinned(upper, kBuckets), page::SeriesStyle::line, false, 0});
  chart.series.push_back({"-3 sigma", page::thinned(lower, kBuckets), page::SeriesStyle::line, false, 0});
  return chart;
}

page::Chart nees_chart(const trajectory_error::PoseConsistency& c) {
  page::Chart chart;
  chart.title = "NEES per degree of freedom";
  chart.caption = "1 on average if the covariance is consistent; more is overconfident.";
  chart.x_label = "time [s]";
  chart.left_label = "NEES / d";
  const std::array<std::pair<const char*, double trajectory_error::PoseConsistencyRow::*>, 2> parts = {
      {{"orientation", &trajectory_error::PoseConsistencyRow::orientation_nees},
       {"position", &trajectory_error::PoseConsistencyRow::position_nees}}};
  for (const auto& [name, nees] : parts) {
    std::vector<Vector2d> points;
    for (const trajectory_error::PoseConsistencyRow& row : c.rows)
      points.emplace_back(seconds_between(c.rows.front().timestamp_ns, row.timestamp_ns), row.*nees);
    chart.series.push_back({name, page::thinned(points, kBuckets)});
  }
  return chart;
}

}  // namespace

std::string to_text(const trajectory_error::PoseConsistency& c, const ConsistencyQuestion& question) {
  const trajectory_error::PartConsistency& o = c.orientation;
  const trajectory_error::PartConsistency& p = c.position;
  const metrics::NeesBounds bounds = metrics::nees_bounds_95(1, 3);
  std::string text = formats_line(question.files) + "normalised estimation error squared\n\n" +
                     text::aligned_columns(heading(c, question)) + "\n";
  text += text::aligned_columns(
      {{"", "orientation", "position"},
       {"NEES / 3 mean", number(o.nees.mean), number(p.nees.mean)},
       {"median", number(o.nees.median), number(p.nees.median)},
       {"max", number(o.nees.max), number(p.nees.max)},
       {"rms error", number(degrees(o.error_rmse)) + " deg", number(p.error_rmse) + " m"},
       {"rms sigma", number(degrees(o.sigma_rms)) + " deg", number(p.sigma_rms) + " m"},
       {"within 3 sigma, x / y / z", shares(o.share_within_3_sigma), shares(p.share_within_3_sigma)}});
  return text + fmt::format(
                    "\nA consistent covariance has NEES / 3 near 1 on average (95 % of single poses "
                    "between {:.2f} and {:.2f}) and 99.7 % within 3 sigma; more NEES is "
                    "overconfident. Errors of one trajectory are correlated: it is one sample.\n",
                    bounds.lower, bounds.upper);
}

std::string to_json(const trajectory_error::PoseConsistency& c, const ConsistencyQuestion& question) {
  const ComparedFiles& files = question.files;
  Json json = {{"metric", "nees"},
               {"reference",
                {{"file", files.reference},
                 {"format", trajectory_files::to_string(files.reference_format)},
                 {"format_source", files.reference_format_source}}},
               {"estimate",
                {{"file", files.estimate},
                 {"format", trajectory_files::to_string(files.estimate_format)},
                 {"format_source", files.estimate_format_source}}},
               {"pairs", c.pairs},
               {"possible", c.possible},
               {"coverage", coverage_of(c)},
               {"singular", c.singular}};
  json["association"] = {{"rule", trajectory_files::to_string(question.association.rule)},
                         {"max_difference_s", question.association.max_difference_s},
                         {"offset_s", question.association.offset_s}};
  json["alignment"] = {{"mode", trajectory_error::to_string(question.alignment.mode)},
                       {"matrix", trajectory_error::matrix_of(c.T_reference_estimate.rigid)}};
  json["orientation"] = json_of_part(c.orientation, "rad");
  json["position"] = json_of_part(c.position, "m");
  return text::json_text(json) + "\n";
}

std::string consistency_csv(const trajectory_error::PoseConsistency& c) {
  std::string text =
      "timestamp_ns,orientation_error_x_rad,orientation_error_y_rad,orientation_error_z_rad,"
      "orientation_sigma_x_rad,orientation_sigma_y_rad,orientation_sigma_z_rad,position_error_x_m,"
      "position_error_y_m,position_error_z_m,position_sigma_x_m,position_sigma_y_m,position_sigma_z_m,"
      "orientation_nees_per_dof,position_nees_per_dof\n";
  for (const trajectory_error::PoseConsistencyRow& row : c.rows) {
    text += fmt::format("{}", row.timestamp_ns);
    for (const Vector3d& v :
         {row.orientation_error_rad, row.orientation_sigma_rad, row.position_error_m, row.position_sigma_m})
      fmt::format_to(std::back_inserter(text), ",{},{},{}", v.x(), v.y(), v.z());
    fmt::format_to(std::back_inserter(text), ",{},{}\n", row.orientation_nees, row.position_nees);
  }
  return text;
}

std::vector<page::Chart> consistency_charts(const trajectory_error::PoseConsistency& c) {
  std::vector<page::Chart> charts;
  for (const int axis : {0, 1, 2})
    charts.push_back(error_chart(c, axis, "Orientation", "deg", kDegreesPerRadian,
                                 &trajectory_error::PoseConsistencyRow::orientation_error_rad,
                                 &trajectory_error::PoseConsistencyRow::orientation_sigma_rad));
  for (const int axis : {0, 1, 2})
    charts.push_back(error_chart(c, axis, "Position", "cm", kCentimetres,
                                 &trajectory_error::PoseConsistencyRow::position_error_m,
                                 &trajectory_error::PoseConsistencyRow::position_sigma_m));
  charts.push_back(nees_chart(c));
  return charts;
}

}  // namespace fusebench::metric_reports
