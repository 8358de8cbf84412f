#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "eval/compare/study/criteria_json.hpp"
#include "eval/compare/study/summary_formats.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::study {

namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json json_of(const ValueSpread& spread, const registry::RunMetric& metric) {
  Json json = {{"runs", spread.count}};
  if (spread.count == 0) return json;
  json["mean"] = spread.mean;
  json["median"] = spread.median;
  json["worst"] = spread.worst;
  json["worst_recording"] = spread.worst_recording;
  if (spread.bounds_95)
    json["bounds_95"] = {{"lower", spread.bounds_95->lower}, {"upper", spread.bounds_95->upper}};
  if (metric.takes_several_runs()) {
    json["partner"] = spread.partner;
    json["partner_mean"] = spread.partner_mean;
  }
  return json;
}

Json json_of(const SummaryRow& row) {
  Json json = {
      {"split", row.split},   {"group", row.group}, {"variant", row.variant},         {"n_ok", row.ok},
      {"n_total", row.total}, {"n_lost", row.lost}, {"lost_frames", row.lost_frames}, {"frames", row.frames}};
  Json values = Json::object();
  const auto columns = registry::columns_of(registry::Column::study);
  for (std::size_t i = 0; i < columns.size(); ++i)
    values[std::string(columns[i]->key)] = json_of(row.values[i], *columns[i]);
  json["values"] = std::move(values);
  return json;
}

Json json_of(const StudySummary& summary, const MotionCurve& curve) {
  Json bins = Json::array();
  for (const MotionBin& bin : curve.bins) {
    const SharedMeans& means = bin.means;
    const bool any = means.frames > 0;
    bins.push_back({{"from_px", bin.from_px},
                    {"to_px", number(bin.to_px)},
                    {"frames", means.frames},
                    {"pixels", means.pixels},
                    {summary.reference, any ? Json(means.reference_grey) : Json(nullptr)},
                    {summary.partner, any ? Json(means.variant_grey) : Json(nullptr)},
                    {"ratio", any ? number(means.variant_grey / means.reference_grey) : Json(nullptr)}});
  }
  return {{"split", curve.split}, {"group", curve.group}, {"bins", bins}};
}

Json json_of(const CriterionMeasurement& measurement) {
  return {{"split", measurement.split},
          {"verdict", to_string(measurement.verdict)},
          {"measured", number(measurement.measured)},
          {"noise", number(measurement.noise)},
          {"limit", measurement.limit},
          {"recordings", measurement.recordings},
          {"note", measurement.note}};
}

Json json_of(const CriterionResult& result) {
  Json json = {{"title", result.criterion.title},
               {"groups", result.criterion.groups},
               {"variant", result.criterion.variant},
               {"against", result.criterion.against},
               {"metric", result.criterion.metric}};
  json.update(json_of(result.decided));
  json["beside"] = json_of(result.beside);
  return json;
}

Json json_of(const Study& study, const StudyRun& run) {
  Json json = {{"recording", run.recording},
               {"variant", run.variant},
               {"group", run.group},
               {"split", run.split},
               {"data", run.record.recording.data},
               {"imu", run.record.recording.imu},
               {"truth", run.record.recording.truth},
               {"repetition", run.record.repetition},
               {"replicate", run.record.replicate},
               {"status", record::to_string(run.record.status)},
               {"reason", run.record.reason},
               {"config_hash", run.record.config_hash},
               {"fingerprint", run.record.recording.fingerprint}};
  Json values = Json::object();
  for (const registry::RunMetric* metric : registry::columns_of(registry::Column::study))
    values[std::string(metric->key)] = number(value_of(study, run, *metric));
  json["values"] = std::move(values);
  return json;
}

void add_once(std::vector<std::string>& texts, std::string text) {
  if (std::ranges::find(texts, text) == texts.end()) texts.push_back(std::move(text));
}

/// UTC, as 2026-11-29; empty if no run has a record.
std::string newest_date(const Study& study) {
  std::optional<std::filesystem::file_time_type> newest;
  for (const StudyRun& run : study.runs) {
    std::error_code missing;
    const auto time = std::filesystem::last_write_time(run.folder / "record.json", missing);
    if (!missing) newest = newest ? std::max(*newest, time) : time;
  }
  if (!newest) return {};
  const auto moment = std::chrono::file_clock::to_sys(*newest);
  return fmt::format("{:%Y-%m-%d}", std::chrono::time_point_cast<std::chrono::seconds>(moment));
}

Json json_of(const SummaryOrigin& origin, const Study& study) {
  std::vector<std::string> versions, machines;
  for (const StudyRun& run : study.runs) {
    const record::RecordedProvenance& made = run.record.provenance;
    if (made.version.empty()) continue;
    add_once(versions, made.git.empty() ? made.version : fmt::format("{} ({})", made.version, made.git));
    add_once(machines, made.cpu);
  }
  return {{"command", origin.command},
          {"date", newest_date(study)},
          {"versions", versions},
          {"machines", machines},
          {"absent", origin.absent}};
}

template <class T>
Json list_of(const std::vector<T>& items) {
  Json list = Json::array();
  for (const T& item : items) list.push_back(json_of(item));
  return list;
}

}  // namespace

Json criteria_json(const std::vector<CriterionResult>& criteria) { return list_of(criteria); }

std::string summary_json(const StudySummary& summary, const Study& study, const SummaryOrigin& origin) {
  Json runs = Json::array();
  for (const StudyRun& run : study.runs) runs.push_back(json_of(study, run));
  Json motion = Json::array();
  for (const MotionCurve& curve : summary.curves) motion.push_back(json_of(summary, curve));
  const Json document = {{"suite", summary.suite},
                         {"origin", json_of(origin, study)},
                         {"criteria", criteria_json(summary.criteria)},
                         {"rows", list_of(summary.rows)},
                         {"motion", motion},
                         {"notes", summary.notes},
                         {"runs", runs}};
  return text::json_text(document) + "\n";
}

}  // namespace fusebench::study
