#include "eval/record/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "core/base/io/bounded_text.hpp"
#include "eval/record/record_metrics.hpp"
#include "eval/record/record_parts.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::record {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const RecordedRecording& recording) {
  Json json = {{"name", recording.name},
               {"format", recording.format},
               {"data", recording.data},
               {"frames", recording.frames},
               {"first_frame", recording.first_frame},
               {"duration_s", recording.duration_s},
               {"fingerprint", recording.fingerprint},
               {"imu", recording.imu},
               {"imu_note", recording.imu_note},
               {"truth", recording.truth},
               {"prepared", recording.prepared},
               {"notes", recording.notes}};
  if (recording.whole_frames > 0) json["whole_frames"] = recording.whole_frames;
  if (recording.start_ns) json["start_ns"] = *recording.start_ns;
  if (recording.camera) json["camera"] = json_of_camera(*recording.camera);
  return json;
}

void read(const Json& json, RecordedRecording& recording) {
  recording.name = json.at("name");
  recording.format = json.at("format");
  recording.data = json.at("data");
  recording.frames = json.at("frames");
  recording.first_frame = json.at("first_frame");
  recording.whole_frames = json.value("whole_frames", std::size_t{0});
  recording.duration_s = json.at("duration_s");
  recording.fingerprint = json.at("fingerprint");
  recording.imu = json.at("imu");
  recording.imu_note = json.at("imu_note");
  recording.truth = json.value("truth", std::string());
  recording.prepared = json.value("prepared", false);
  recording.notes = json.at("notes").get<std::vector<std::string>>();
  if (const auto start = json.find("start_ns"); start != json.end()) {
    constexpr std::int64_t kFarthest_ns = std::numeric_limits<std::int64_t>::max() / 2;
    recording.start_ns = start->get<std::int64_t>();
    if (*recording.start_ns > kFarthest_ns || *recording.start_ns < -kFarthest_ns)
      throw std::invalid_argument(fmt::format("recording.start_ns = {} (allowed: -{} .. {})",
                                              *recording.start_ns, kFarthest_ns, kFarthest_ns));
  }
  if (const auto camera = json.find("camera"); camera != json.end()) recording.camera = camera_of(*camera);
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
    config::OptionValue typed = value.is_boolean()          ? config::OptionValue{value.get<bool>()}
                                : value.is_number_integer() ? config::OptionValue{value.get<std::int64_t>()}
                                : value.is_number()         ? config::OptionValue{value.get<double>()}
                                                            : config::OptionValue{value.get<std::string>()};
    config.push_back({key, std::move(typed), entry.at("origin")});
  }
  return config;
}

Json json_of(const std::vector<filter::SensorConstant>& sensors) {
  Json json = Json::object();
  for (const filter::SensorConstant& constant : sensors)
    json[constant.name] = {{"value", constant.value}, {"sigma", constant.sigma}};
  return json;
}

Json json_of(const std::vector<RecordedFile>& files) {
  Json json = Json::object();
  for (const RecordedFile& file : files) json[file.name] = {{"bytes", file.bytes}, {"xxh3", file.xxh3}};
  return json;
}

/// None in an older record.
std::vector<RecordedFile> files_of(const Json& json) {
  std::vector<RecordedFile> files;
  if (!json.contains("files")) return files;
  for (const auto& [name, file] : json.at("files").items()) {
    files.push_back({name, file.at("bytes").get<std::uint64_t>(), file.at("xxh3").get<std::string>()});
  }
  return files;
}

Json json_of(const RecordedTiming& timing) {
  Json stages = Json::object();
  for (const auto& [name, milliseconds] : timing.stages_ms) stages[name] = milliseconds;
  Json json = {{"wall_s", timing.wall_s},
               {"cpu_s", timing.cpu_s},
               {"peak_rss_bytes", timing.peak_rss_bytes},
               {"fps", timing.fps},
               {"stages_ms", stages}};
  for (const auto& [name, histogram] : timing.histograms) json["histogram_ms"][name] = json_of(histogram);
  if (!timing.files.empty()) json["files"] = json_of(timing.files);
  return json;
}

void read(const Json& json, RecordedTiming& timing) {
  timing.wall_s = json.at("wall_s");
  timing.cpu_s = json.at("cpu_s");
  timing.peak_rss_bytes = json.at("peak_rss_bytes");
  timing.fps = json.at("fps");
  for (const auto& [name, milliseconds] : json.at("stages_ms").items()) {
    timing.stages_ms.emplace_back(name, milliseconds.get<double>());
  }
  timing.files = files_of(json);
  if (!json.contains("histogram_ms")) return;
  for (const auto& [name, histogram] : json.at("histogram_ms").items()) {
    timing.histograms.emplace_back(name, DurationHistogram{});
    read(histogram, timing.histograms.back().second);
  }
}

Json json_of(const RecordedProvenance& provenance) {
  return {{"version", provenance.version},     {"git", provenance.git},  {"compiler", provenance.compiler},
          {"flags", provenance.flags},         {"cpu", provenance.cpu},  {"threads", provenance.threads},
          {"estimator", provenance.estimator}, {"host", provenance.host}};
}

void read(const Json& json, RecordedProvenance& provenance) {
  provenance.version = json.at("version");
  provenance.git = json.at("git");
  provenance.compiler = json.at("compiler");
  provenance.flags = json.at("flags");
  provenance.estimator = json.value("estimator", "");
  provenance.cpu = json.at("cpu");
  provenance.threads = json.at("threads");
  provenance.host = json.at("host");
}

/// A record of another version of this program: not damaged, but not to be read here.
struct OtherSchema {
  int schema = 0;
};

RunStatus status_of(const std::string& text) {
  if (const auto status = parse_run_status(text)) return *status;
  throw std::invalid_argument(fmt::format("status = {} (allowed: ok | lost | failed)", text));
}

PoseKind pose_kind_of(const std::string& text) {
  if (const auto poses = parse_pose_kind(text)) return *poses;
  throw std::invalid_argument(fmt::format("poses = {} (allowed: online | final)", text));
}

RunRecord record_of(const Json& json) {
  RunRecord record;
  record.schema = json.at("schema");
  if (record.schema != kRecordSchema) throw OtherSchema{record.schema};
  record.status = status_of(json.at("status"));
  record.reason = json.at("reason");
  record.run_id = json.value("run_id", "");
  record.repetition = json.value("repetition", 1);
  record.replicate = json.value("replicate", 0);  // older records have none
  read(json.at("recording"), record.recording);
  record.variant = json.at("variant");
  record.poses = pose_kind_of(json.value("poses", "online"));  // older records do not say it
  if (const auto program = json.find("program"); program != json.end())
    record.program = {program->at("definition"), program->at("version"), program->at("seed")};
  record.config = config_of(json.at("config"));
  record.config_hash = json.at("config_hash");
  read_metrics(json.at("metrics"), record.metrics);
  if (const auto final = json.find("final_metrics"); final != json.end())
    read_metrics(*final, record.final_metrics.emplace());
  if (const auto loops = json.find("loops"); loops != json.end()) record.loops = loops_of(*loops);
  const Json& frames = json.at("frames");
  record.frames = {frames.at("total"),
                   frames.at("tracked"),
                   frames.at("lost"),
                   frames.value("other_segments", std::size_t{0}),
                   frames.value("segments", std::size_t{0}),
                   frames.value("segments_joined", std::size_t{0})};
  const Json& model = json.at("model");
  record.model = {model.at("vertices"), model.at("triangles"), model.at("blocks")};
  const auto sensors = json.find("sensors");  // older records have none
  if (sensors != json.end()) {
    for (const auto& [name, constant] : sensors->items())
      record.sensors.push_back({name, constant.at("value"), constant.at("sigma")});
  }
  record.files = files_of(json);
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

std::string segments_text(const RecordedFrames& frames) {
  if (frames.segments == 0) return {};
  return fmt::format("{} frames in {} segment{} apart from the map, {} joined", frames.other_segments,
                     frames.segments, frames.segments == 1 ? "" : "s", frames.segments_joined);
}

double coverage_share(const RecordedFrames& frames) {
  return frames.total == 0 ? 0.0 : static_cast<double>(frames.tracked) / static_cast<double>(frames.total);
}

std::string status_text(RunStatus status, std::optional<std::size_t> silent) {
  if (silent.value_or(0) == 0) return std::string(to_string(status));
  return fmt::format("{} ({} undetected)", to_string(status), *silent);
}

std::optional<RunStatus> parse_run_status(std::string_view text) {
  for (const RunStatus status : {RunStatus::ok, RunStatus::lost, RunStatus::failed}) {
    if (text == to_string(status)) return status;
  }
  return std::nullopt;
}

std::string_view to_string(PoseKind poses) { return poses == PoseKind::online ? "online" : "final"; }

std::optional<PoseKind> parse_pose_kind(std::string_view text) {
  for (const PoseKind poses : {PoseKind::online, PoseKind::final}) {
    if (text == to_string(poses)) return poses;
  }
  return std::nullopt;
}

namespace {

Json document_of(const RunRecord& record) {
  Json json = {{"schema", record.schema},
               {"status", to_string(record.status)},
               {"reason", record.reason},
               {"run_id", record.run_id},
               {"repetition", record.repetition},
               {"replicate", record.replicate},
               {"recording", json_of(record.recording)},
               {"variant", record.variant},
               {"poses", to_string(record.poses)},
               {"config_hash", record.config_hash},
               {"metrics", json_of_metrics(record.metrics, record.frames)},
               {"frames",
                {{"total", record.frames.total},
                 {"tracked", record.frames.tracked},
                 {"lost", record.frames.lost},
                 {"other_segments", record.frames.other_segments},
                 {"segments", record.frames.segments},
                 {"segments_joined", record.frames.segments_joined}}},
               {"model",
                {{"vertices", record.model.vertices},
                 {"triangles", record.model.triangles},
                 {"blocks", record.model.blocks}}},
               {"sensors", json_of(record.sensors)},
               {"files", json_of(record.files)},
               {"config", json_of(record.config)},
               {"timing", json_of(record.timing)},
               {"provenance", json_of(record.provenance)}};
  if (record.final_metrics) json["final_metrics"] = json_of_metrics(*record.final_metrics, record.frames);
  if (record.loops) json["loops"] = json_of_loops(*record.loops);
  if (record.program) {
    json["program"] = {{"definition", record.program->definition},
                       {"version", record.program->version},
                       {"seed", record.program->seed}};
  }
  return json;
}

/// Metrics whose numbers are NaN where no frame, or no part of a surface, has any, which is null in the
/// document.
constexpr std::array<std::string_view, 4> kMayHaveNone = {"aie", "intensity_readings", "residuals", "mesh"};

/// Place and value of the first number that is infinite, or NaN where that does not mean none
/// ("metrics.ate.stats.rmse = nan"); empty if there is none.
std::string not_finite(const Json& json, const std::string& place = {}, bool none_allowed = false) {
  if (json.is_number_float()) {
    const double value = json.get<double>();
    const bool good = std::isfinite(value) || (none_allowed && std::isnan(value));
    return good ? std::string() : fmt::format("{} = {}", place, value);
  }
  if (!json.is_structured()) return {};
  for (const auto& [key, value] : json.items()) {
    const bool allowed = none_allowed || std::ranges::find(kMayHaveNone, key) != kMayHaveNone.end();
    const std::string found = not_finite(value, place.empty() ? key : place + "." + key, allowed);
    if (!found.empty()) return found;
  }
  return {};
}

}  // namespace

std::string to_json(const RunRecord& record) { return text::json_text(document_of(record)) + "\n"; }

void fail_if_not_finite(RunRecord& record) {
  const std::string number = not_finite(document_of(record));
  if (number.empty()) return;
  record.status = RunStatus::failed;
  record.reason = fmt::format("{}{}{} is no finite number: the record is left without metrics", record.reason,
                              record.reason.empty() ? "" : "; ", number);
  record.metrics = {};
  record.final_metrics.reset();
  record.loops.reset();
  record.sensors.clear();
}

std::string no_json(std::string_view text, std::size_t byte) {
  if (text.empty()) return "empty";
  const std::size_t at = std::min(byte, text.size());
  const bool ends = byte > text.size();
  const bool zeros = at > 0 && text[at - 1] == '\0';
  return fmt::format("not JSON at byte {}{}", at,
                     zeros  ? " (zeros after a power cut?)"
                     : ends ? ", where it ends"
                            : "");
}

Result<RunRecord> parse_record(std::string_view json, const std::string& name) {
  try {
    return record_of(Json::parse(json));
  } catch (const OtherSchema& other) {
    return fail(ErrorCode::configuration,
                fmt::format("{}: schema = {} (this program reads {})", name, other.schema, kRecordSchema),
                "another version of this program wrote it");
  } catch (const nlohmann::json::parse_error& error) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", name, no_json(json, error.byte)));
  } catch (const nlohmann::json::type_error&) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: a value of it is of another kind than a record's", name));
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception.out_of_range.403] key 'variant' not found"
    const std::string_view text = error.what();
    const std::size_t prefix = text.find("] ");
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: {}", name, text.substr(prefix == std::string_view::npos ? 0 : prefix + 2)));
  } catch (const std::invalid_argument& error) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", name, error.what()));
  }
}

Result<RunRecord> read_record(const std::filesystem::path& file) {
  const auto text = io::whole_text(file, kMostRecordBytes, "record");
  if (!text) return tl::unexpected(text.error());
  return parse_record(*text, file.string());
}

}  // namespace fusebench::record
