#include "eval/record.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <type_traits>

#include "eval/json_text.hpp"

namespace fusebench {

namespace {

using Json = nlohmann::ordered_json;

// NaN is dumped as null; null is read as NaN.
double number_at(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

// ---- statistics and alignment

Json json_of(const Statistics& stats) {
  if (stats.count == 0) return nullptr;
  return {{"rmse", stats.rmse}, {"mean", stats.mean}, {"median", stats.median}, {"std", stats.std},
          {"min", stats.min},   {"max", stats.max},   {"sse", stats.sse},       {"count", stats.count}};
}

Statistics statistics_of(const Json& json) {
  if (json.is_null()) return {};
  return {number_at(json, "rmse"),   number_at(json, "mean"),
          number_at(json, "median"), number_at(json, "std"),
          number_at(json, "min"),    number_at(json, "max"),
          number_at(json, "sse"),    json.at("count").get<std::size_t>()};
}

Json json_of(const Alignment& alignment) {
  return {{"mode", alignment.mode}, {"matrix", matrix_of(alignment.T_reference_estimate)}};
}

Alignment alignment_of(const Json& json) {
  const auto m = json.at("matrix").get<std::array<double, 16>>();
  Matrix3d rotation;
  rotation << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  return {json.at("mode"), {Quaterniond(rotation), {m[3], m[7], m[11]}}};
}

// ---- metrics

Json json_of(const AteResult& ate) {
  return {{"protocol", ate.protocol},
          {"relation", ate.relation},
          {"unit", ate.unit},
          {"pairs", ate.pairs},
          {"possible", ate.possible},
          {"coverage", ate.coverage},
          {"max_difference_s", ate.max_difference_s},
          {"alignment", json_of(ate.alignment)},
          {"stats", json_of(ate.stats)}};
}

void read(const Json& json, AteResult& ate) {
  ate.protocol = json.at("protocol");
  ate.relation = json.at("relation");
  ate.unit = json.at("unit");
  ate.pairs = json.at("pairs");
  ate.possible = json.at("possible");
  ate.coverage = json.at("coverage");
  ate.max_difference_s = json.at("max_difference_s");
  ate.alignment = alignment_of(json.at("alignment"));
  ate.stats = statistics_of(json.at("stats"));
}

Json json_of(const RpeResult& rpe) {
  return {{"protocol", rpe.protocol},
          {"delta", rpe.delta},
          {"delta_unit", to_string(rpe.unit)},
          {"pairs", rpe.pairs},
          {"possible", rpe.possible},
          {"coverage", rpe.coverage},
          {"max_difference_s", rpe.max_difference_s},
          {"alignment", json_of(rpe.alignment)},
          {"translation", {{"unit", "m"}, {"stats", json_of(rpe.translation)}}},
          {"rotation", {{"unit", "rad"}, {"stats", json_of(rpe.rotation)}}}};
}

void read(const Json& json, RpeResult& rpe) {
  rpe.protocol = json.at("protocol");
  rpe.delta = json.at("delta");
  rpe.unit = json.at("delta_unit") == to_string(DeltaUnit::frames) ? DeltaUnit::frames : DeltaUnit::seconds;
  rpe.pairs = json.at("pairs");
  rpe.possible = json.at("possible");
  rpe.coverage = json.at("coverage");
  rpe.max_difference_s = json.at("max_difference_s");
  rpe.alignment = alignment_of(json.at("alignment"));
  rpe.translation = statistics_of(json.at("translation").at("stats"));
  rpe.rotation = statistics_of(json.at("rotation").at("stats"));
}

Json json_of(const IntensitySummary& summary) {
  return {{"aie", summary.aie_grey},
          {"rms", summary.rms_grey},
          {"pixels", summary.pixels},
          {"frames", summary.frames},
          {"frames_excluded", summary.frames_excluded},
          {"stats", json_of(summary.stats)}};
}

IntensitySummary summary_of(const Json& json) {
  return {number_at(json, "aie"),
          number_at(json, "rms"),
          json.at("pixels").get<std::size_t>(),
          json.at("frames").get<std::size_t>(),
          json.at("frames_excluded").get<std::size_t>(),
          statistics_of(json.at("stats"))};
}

Json json_of(const IntensityResult& aie) {
  Json json = {{"protocol", "mean over frames of the mean over visible pixels of tracked patches"},
               {"unit", "grey levels 0-255"}};
  json.update(json_of(aie.all));
  json["accepted"] = json_of(aie.accepted);
  return json;
}

void read(const Json& json, IntensityResult& aie) {
  aie.all = summary_of(json);
  aie.accepted = summary_of(json.at("accepted"));
}

template <class T>
Json json_of(const Outcome<T>& outcome) {
  if (outcome.value) return json_of(*outcome.value);
  return {{"stats", nullptr}, {"reason", outcome.reason}};
}

template <class T>
Outcome<T> outcome_of(const Json& json) {
  if (json.contains("reason")) return {std::nullopt, json.at("reason")};
  Outcome<T> outcome{T{}, {}};
  read(json, *outcome.value);
  return outcome;
}

Json json_of_metrics(const RunRecord& record) {
  const double share = record.frames.total == 0 ? 0.0
                                                : static_cast<double>(record.frames.tracked) /
                                                      static_cast<double>(record.frames.total);
  return {
      {"ate", json_of(record.metrics.ate)},
      {"rpe", {{"frame", json_of(record.metrics.rpe_frame)}, {"second", json_of(record.metrics.rpe_second)}}},
      {"aie", json_of(record.metrics.aie)},
      {"coverage",
       {{"protocol", "tracked frames / frames of the recording"},
        {"tracked", record.frames.tracked},
        {"total", record.frames.total},
        {"share", share}}}};
}

void read_metrics(const Json& json, RecordedMetrics& metrics) {
  metrics.ate = outcome_of<AteResult>(json.at("ate"));
  metrics.rpe_frame = outcome_of<RpeResult>(json.at("rpe").at("frame"));
  metrics.rpe_second = outcome_of<RpeResult>(json.at("rpe").at("second"));
  metrics.aie = outcome_of<IntensityResult>(json.at("aie"));
}

// ---- what was asked, and what made it

Json json_of(const RecordedRecording& recording) {
  return {{"name", recording.name},
          {"format", recording.format},
          {"data", recording.data},
          {"frames", recording.frames},
          {"first_frame", recording.first_frame},
          {"duration_s", recording.duration_s},
          {"fingerprint", recording.fingerprint},
          {"imu", recording.imu},
          {"imu_note", recording.imu_note},
          {"notes", recording.notes}};
}

void read(const Json& json, RecordedRecording& recording) {
  recording.name = json.at("name");
  recording.format = json.at("format");
  recording.data = json.at("data");
  recording.frames = json.at("frames");
  recording.first_frame = json.at("first_frame");
  recording.duration_s = json.at("duration_s");
  recording.fingerprint = json.at("fingerprint");
  recording.imu = json.at("imu");
  recording.imu_note = json.at("imu_note");
  recording.notes = json.at("notes").get<std::vector<std::string>>();
}

Json json_of(const std::vector<RecordedOption>& config) {
  Json json = Json::object();
  for (const RecordedOption& option : config) {
    Json value;
    std::visit([&](const auto& given) { value = given; }, option.value);
    json[option.key] = {{"value", value}, {"origin", option.origin}};
  }
  return json;
}

std::vector<RecordedOption> config_of(const Json& json) {
  std::vector<RecordedOption> config;
  for (const auto& [key, entry] : json.items()) {
    const Json& value = entry.at("value");
    OptionValue typed = value.is_boolean()          ? OptionValue{value.get<bool>()}
                        : value.is_number_integer() ? OptionValue{value.get<std::int64_t>()}
                        : value.is_number()         ? OptionValue{value.get<double>()}
                                                    : OptionValue{value.get<std::string>()};
    config.push_back({key, std::move(typed), entry.at("origin")});
  }
  return config;
}

Json json_of(const RecordedTiming& timing) {
  Json stages = Json::object();
  for (const auto& [name, milliseconds] : timing.stages_ms) stages[name] = milliseconds;
  return {{"wall_s", timing.wall_s},
          {"cpu_s", timing.cpu_s},
          {"peak_rss_bytes", timing.peak_rss_bytes},
          {"fps", timing.fps},
          {"stages_ms", stages}};
}

void read(const Json& json, RecordedTiming& timing) {
  timing.wall_s = json.at("wall_s");
  timing.cpu_s = json.at("cpu_s");
  timing.peak_rss_bytes = json.at("peak_rss_bytes");
  timing.fps = json.at("fps");
  for (const auto& [name, milliseconds] : json.at("stages_ms").items()) {
    timing.stages_ms.emplace_back(name, milliseconds.get<double>());
  }
}

Json json_of(const RecordedProvenance& provenance) {
  return {{"version", provenance.version}, {"git", provenance.git}, {"compiler", provenance.compiler},
          {"flags", provenance.flags},     {"cpu", provenance.cpu}, {"threads", provenance.threads},
          {"host", provenance.host}};
}

void read(const Json& json, RecordedProvenance& provenance) {
  provenance.version = json.at("version");
  provenance.git = json.at("git");
  provenance.compiler = json.at("compiler");
  provenance.flags = json.at("flags");
  provenance.cpu = json.at("cpu");
  provenance.threads = json.at("threads");
  provenance.host = json.at("host");
}

RunStatus status_of(const std::string& text) {
  for (const RunStatus status : {RunStatus::ok, RunStatus::lost, RunStatus::failed}) {
    if (text == to_string(status)) return status;
  }
  throw std::invalid_argument(fmt::format("status = {} (allowed: ok | lost | failed)", text));
}

RunRecord record_of(const Json& json) {
  RunRecord record;
  record.schema = json.at("schema");
  if (record.schema != kRecordSchema) {
    throw std::invalid_argument(
        fmt::format("schema = {} (this program reads {})", record.schema, kRecordSchema));
  }
  record.status = status_of(json.at("status"));
  record.reason = json.at("reason");
  read(json.at("recording"), record.recording);
  record.variant = json.at("variant");
  record.config = config_of(json.at("config"));
  record.config_hash = json.at("config_hash");
  read_metrics(json.at("metrics"), record.metrics);
  const Json& frames = json.at("frames");
  record.frames = {frames.at("total"), frames.at("tracked"), frames.at("lost")};
  const Json& model = json.at("model");
  record.model = {model.at("vertices"), model.at("triangles"), model.at("blocks")};
  read(json.at("timing"), record.timing);
  read(json.at("provenance"), record.provenance);
  return record;
}

}  // namespace

std::string_view to_string(RunStatus status) {
  switch (status) {
    case RunStatus::failed:
      return "failed";
    case RunStatus::lost:
      return "lost";
    case RunStatus::ok:
      return "ok";
  }
  return "unknown";
}

std::string to_json(const RunRecord& record) {
  const Json json = {
      {"schema", record.schema},
      {"status", to_string(record.status)},
      {"reason", record.reason},
      {"recording", json_of(record.recording)},
      {"variant", record.variant},
      {"config_hash", record.config_hash},
      {"metrics", json_of_metrics(record)},
      {"frames",
       {{"total", record.frames.total}, {"tracked", record.frames.tracked}, {"lost", record.frames.lost}}},
      {"model",
       {{"vertices", record.model.vertices},
        {"triangles", record.model.triangles},
        {"blocks", record.model.blocks}}},
      {"config", json_of(record.config)},
      {"timing", json_of(record.timing)},
      {"provenance", json_of(record.provenance)}};
  return json_text(json) + "\n";
}

Result<RunRecord> parse_record(std::string_view json, const std::string& name) {
  try {
    return record_of(Json::parse(json));
  } catch (const nlohmann::json::exception& error) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", name, error.what()));
  } catch (const std::invalid_argument& error) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", name, error.what()));
  }
}

Result<RunRecord> read_record(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return fail(ErrorCode::data_missing, fmt::format("{}: cannot be opened", file.string()));
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_record(text.str(), file.string());
}

}  // namespace fusebench
