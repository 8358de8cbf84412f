#include "eval/report/metric_reports/trajectory_report.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "core/base/geometry.hpp"
#include "eval/metrics/reference_clock/clock_json.hpp"
#include "eval/metrics/statistics_json.hpp"
#include "eval/metrics/trajectory_error/alignment_json.hpp"
#include "eval/report/metric_reports/clock_report.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::metric_reports {

namespace {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::vector<std::string>>;

/// "a [m]", or "a" of what has no unit.
std::string with_unit(const trajectory_error::ErrorSeries& series) {
  return series.unit.empty() ? series.relation : fmt::format("{} [{}]", series.relation, series.unit);
}

/// TUM's relative errors pair motions, not poses.
bool pairs_of_tum(const trajectory_error::TrajectoryRequest& request) {
  return request.metric == trajectory_error::TrajectoryMetric::rpe &&
         (request.motions == trajectory_error::MotionRule::fixed_delta ||
          request.motions == trajectory_error::MotionRule::each_to_each);
}

std::string association_text(const trajectory_error::TrajectoryEvaluation& e) {
  const trajectory_files::AssociationOptions& a = e.request.association;
  std::string how;
  if (pairs_of_tum(e.request))
    return fmt::format("nearest reference pose within {:.6g} s (at most twice its median interval)",
                       a.max_difference_s);
  switch (a.rule) {
    case trajectory_files::AssociationRule::nearest:
      how = fmt::format("nearest stamp within {:.6g} s, one may serve several", a.max_difference_s);
      break;
    case trajectory_files::AssociationRule::greedy:
      how = fmt::format("closest stamps first, one to one, less than {:.6g} s apart", a.max_difference_s);
      break;
    case trajectory_files::AssociationRule::index:
      how = "by the number of the pose";
      break;
    case trajectory_files::AssociationRule::number:
      how = "by the number of the frame";
      break;
    case trajectory_files::AssociationRule::interpolated:
      how = fmt::format("reference interpolated in gaps of at most {:.6g} s", a.max_difference_s);
      break;
    case trajectory_files::AssociationRule::held:
      how = "estimate interpolated, and held where it has no pose";
      break;
  }
  if (a.offset_s != 0) how += fmt::format(", estimate's stamps moved by {:+.6g} s", a.offset_s);
  return how;
}

std::string alignment_text(const trajectory_error::TrajectoryEvaluation& e) {
  const trajectory_error::AlignmentRequest& request = e.request.alignment;
  if (request.mode == trajectory_error::AlignmentMode::none) return "none";
  const Vector3d& t = e.alignment.rigid.translation;
  const std::string from = request.mode == trajectory_error::AlignmentMode::origin ? "from the first pair"
                           : request.first > 0 ? fmt::format("from the first {} pairs", request.first)
                                               : "from all pairs";
  return fmt::format("{} {}: turned by {:.4f} deg, moved by ({:.4f}, {:.4f}, {:.4f}) m, scale {:.6g}",
                     trajectory_error::to_string(request.mode), from,
                     degrees(so3_log(e.alignment.rigid.rotation).norm()), t.x(), t.y(), t.z(),
                     e.alignment.scale);
}

std::string offset_text(const trajectory_error::FittedOffset& fit) {
  const Vector3d& offset_m = fit.offset_m;
  const Vector3d sigma_m = fit.covariance_m2.diagonal().cwiseSqrt();
  return fmt::format(
      "({:.4f}, {:.4f}, {:.4f}) +- ({:.4f}, {:.4f}, {:.4f}) m, the camera in the reference's body; with SE3 "
      "alignment",
      offset_m.x(), offset_m.y(), offset_m.z(), sigma_m.x(), sigma_m.y(), sigma_m.z());
}

std::string motions_text(const trajectory_error::TrajectoryEvaluation& e) {
  const trajectory_error::TrajectoryRequest& r = e.request;
  if (r.motions == trajectory_error::MotionRule::segments)
    return "segments of given lengths along the reference";
  if (r.motions == trajectory_error::MotionRule::each_to_each)
    return "every pose with every pose of the estimate";
  std::string text = fmt::format("{}, delta {:.6g} {}", trajectory_error::to_string(r.motions), r.delta.value,
                                 trajectory_error::to_string(r.delta.unit));
  if (r.motions == trajectory_error::MotionRule::all && r.delta.unit != trajectory_error::DeltaUnit::frames)
    text += fmt::format(" within {:.6g} %", 100 * r.delta_tolerance);
  return text + (r.from_reference ? ", selected from the reference" : ", selected from the estimate");
}

Lines heading(const trajectory_error::TrajectoryEvaluation& e, const ComparedFiles& files) {
  const bool relative = e.request.metric == trajectory_error::TrajectoryMetric::rpe;
  Lines lines = {
      {"protocol", fmt::format("{} ({})", trajectory_error::to_string(e.request.protocol),
                               trajectory_error::source_of(e.request.protocol))},
      {"reference", fmt::format("{} ({}): {} poses", files.reference,
                                trajectory_files::to_string(files.reference_format), e.reference_poses)},
      {"estimate", fmt::format("{} ({}): {} poses", files.estimate,
                               trajectory_files::to_string(files.estimate_format), e.estimate_poses)},
      {"association", association_text(e)},
      {pairs_of_tum(e.request) ? "compared" : "pairs",
       fmt::format("{} of {} possible (coverage {:.1f} %)", e.pairs, e.possible, 100 * e.coverage)},
      {"alignment", alignment_text(e)}};
  if (e.time_coverage)
    lines.insert(lines.end() - 1,
                 {"time", fmt::format("{:.1f} % of the reference's is covered by the estimate",
                                      100 * *e.time_coverage)});
  if (e.fitted_offset) lines.push_back({"fitted offset", offset_text(*e.fitted_offset)});
  if (relative) lines.push_back({"motions", motions_text(e)});
  if (e.request.plane != trajectory_error::Plane::none)
    lines.push_back({"plane", std::string(trajectory_error::to_string(e.request.plane))});
  return lines;
}

/// A column of statistics for each series.
std::string statistics_text(const trajectory_error::TrajectoryEvaluation& e) {
  constexpr std::array<std::pair<const char*, double metrics::Statistics::*>, 7> kRows{
      {{"rmse", &metrics::Statistics::rmse},
       {"mean", &metrics::Statistics::mean},
       {"median", &metrics::Statistics::median},
       {"std", &metrics::Statistics::std},
       {"min", &metrics::Statistics::min},
       {"max", &metrics::Statistics::max},
       {"sse", &metrics::Statistics::sse}}};
  Lines lines = {{""}};
  for (const trajectory_error::ErrorSeries& series : e.series) lines[0].push_back(with_unit(series));
  for (const auto& [name, value] : kRows) {
    lines.push_back({name});
    for (const trajectory_error::ErrorSeries& series : e.series)
      lines.back().push_back(text::seven_digits(series.stats.*value));
  }
  lines.push_back({"errors"});
  for (const trajectory_error::ErrorSeries& series : e.series)
    lines.back().push_back(fmt::format("{}", series.stats.count));
  return text::aligned_columns(lines);
}

std::string segments_text(const trajectory_error::TrajectoryEvaluation& e) {
  Lines lines = {{"length [m]", "segments", "translation mean [m]", "mean [%]", "median [%]",
                  "rotation mean [deg]", "mean [deg/m]", "yaw mean [deg]", "gravity mean [deg]"}};
  for (const trajectory_error::SegmentRow& row : e.segments) {
    lines.push_back(
        {text::seven_digits(row.length_m), fmt::format("{}", row.segments),
         text::seven_digits(row.translation_m.mean), text::seven_digits(row.translation_percent.mean),
         text::seven_digits(row.translation_percent.median), text::seven_digits(row.rotation_deg.mean),
         text::seven_digits(row.rotation_deg_per_m.mean), text::seven_digits(row.yaw_deg.mean),
         text::seven_digits(row.gravity_deg.mean)});
  }
  return text::aligned_columns(lines);
}

Json json_of(const trajectory_error::Similarity& alignment) {
  const Matrix3d R = alignment.scale * alignment.rigid.rotation_matrix();
  const Vector3d& t = alignment.rigid.translation;
  return {R(0, 0), R(0, 1), R(0, 2), t.x(), R(1, 0), R(1, 1), R(1, 2), t.y(),
          R(2, 0), R(2, 1), R(2, 2), t.z(), 0.0,     0.0,     0.0,     1.0};
}

Json json_of(const trajectory_error::ErrorSeries& series, EachError each) {
  Json json = {{"relation", series.relation}, {"unit", series.unit}};
  if (each == EachError::listed) {
    json["errors"] = series.errors;
    json["timestamps_ns"] = series.at_ns;
  }
  json["stats"] = metrics::json_of(series.stats);
  return json;
}

Json json_of(const trajectory_error::SegmentRow& row) {
  return {{"length_m", row.length_m},
          {"segments", row.segments},
          {"translation_m", metrics::json_of(row.translation_m)},
          {"translation_percent", metrics::json_of(row.translation_percent)},
          {"rotation_deg", metrics::json_of(row.rotation_deg)},
          {"rotation_deg_per_m", metrics::json_of(row.rotation_deg_per_m)},
          {"yaw_deg", metrics::json_of(row.yaw_deg)},
          {"gravity_deg", metrics::json_of(row.gravity_deg)}};
}

Json motions_json(const trajectory_error::TrajectoryRequest& request) {
  Json json = {{"rule", trajectory_error::to_string(request.motions)}};
  if (request.motions == trajectory_error::MotionRule::segments ||
      request.motions == trajectory_error::MotionRule::each_to_each)
    return json;
  json["delta"] = request.delta.value;
  json["delta_unit"] = trajectory_error::to_string(request.delta.unit);
  if (request.motions == trajectory_error::MotionRule::all) json["tolerance"] = request.delta_tolerance;
  json["selected_from"] = request.from_reference ? "reference" : "estimate";
  return json;
}

}  // namespace

std::string formats_line(const ComparedFiles& files) {
  return fmt::format("formats: reference {} ({}), estimate {} ({})\n",
                     trajectory_files::to_string(files.reference_format), files.reference_format_source,
                     trajectory_files::to_string(files.estimate_format), files.estimate_format_source);
}

std::string to_text(const trajectory_error::TrajectoryEvaluation& evaluation, const ComparedFiles& files,
                    const std::optional<reference_clock::ReferenceClock>& clock) {
  std::string text = formats_line(files);
  text += evaluation.request.metric == trajectory_error::TrajectoryMetric::ate
              ? "absolute trajectory error\n\n"
              : "relative pose error\n\n";
  text += text::aligned_columns(heading(evaluation, files));
  text += '\n';
  if (!evaluation.segments.empty()) text += segments_text(evaluation) + "\nall segments:\n";
  text += statistics_text(evaluation);
  return clock ? text + "\n" + clock_text(*clock) : text;
}

std::string to_json(const trajectory_error::TrajectoryEvaluation& evaluation, const ComparedFiles& files,
                    EachError each, const std::optional<reference_clock::ReferenceClock>& clock) {
  const trajectory_error::TrajectoryRequest& request = evaluation.request;
  const trajectory_error::ErrorSeries& first = evaluation.series.front();
  Json json = {{"metric", trajectory_error::to_string(request.metric)},
               {"protocol", trajectory_error::to_string(request.protocol)},
               {"protocol_source", trajectory_error::source_of(request.protocol)},
               {"reference",
                {{"file", files.reference},
                 {"format", trajectory_files::to_string(files.reference_format)},
                 {"format_source", files.reference_format_source},
                 {"poses", evaluation.reference_poses}}},
               {"estimate",
                {{"file", files.estimate},
                 {"format", trajectory_files::to_string(files.estimate_format)},
                 {"format_source", files.estimate_format_source},
                 {"poses", evaluation.estimate_poses}}},
               {"relation", first.relation},
               {"unit", first.unit},
               {"pairs", evaluation.pairs},
               {"possible", evaluation.possible},
               {"coverage", evaluation.coverage}};
  if (evaluation.time_coverage) json["time_coverage"] = *evaluation.time_coverage;
  json["association"] = {{"rule", trajectory_files::to_string(request.association.rule)},
                         {"max_difference_s", request.association.max_difference_s},
                         {"offset_s", request.association.offset_s}};
  json["alignment"] = {{"mode", trajectory_error::to_string(request.alignment.mode)},
                       {"first", request.alignment.first},
                       {"scale", evaluation.alignment.scale},
                       {"matrix", json_of(evaluation.alignment)}};
  if (evaluation.fitted_offset) json["fitted_offset"] = trajectory_error::json_of(*evaluation.fitted_offset);
  if (clock) json["reference_clock"] = reference_clock::json_of(*clock);
  json["plane"] = trajectory_error::to_string(request.plane);
  if (request.metric == trajectory_error::TrajectoryMetric::rpe) json["motions"] = motions_json(request);
  json.update(json_of(first, each));
  if (evaluation.series.size() > 1) {
    Json also = Json::array();
    for (std::size_t i = 1; i < evaluation.series.size(); ++i)
      also.push_back(json_of(evaluation.series[i], each));
    json["also"] = std::move(also);
  }
  if (!evaluation.segments.empty()) {
    Json rows = Json::array();
    for (const trajectory_error::SegmentRow& row : evaluation.segments) rows.push_back(json_of(row));
    json["segments"] = std::move(rows);
  }
  return text::json_text(json) + "\n";
}

}  // namespace fusebench::metric_reports
