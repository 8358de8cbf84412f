#include "eval/record/record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/eval/record/sample_record.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/repository.hpp"

namespace fusebench {

using namespace config;
using namespace metrics;
using namespace trajectory_error;
using namespace mesh_error;
using namespace record;

namespace {

using nlohmann::json;
using testing::complete_record;
using testing::sample_record;

TEST(Record, ReadsBackWhatItWrote) {
  const std::string text = to_json(sample_record());
  const auto back = parse_record(text, "record.json");
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_EQ(to_json(*back), text);
  EXPECT_EQ(back->status, RunStatus::ok);
  EXPECT_EQ(back->metrics.ate.value->stats.rmse, sample_record().metrics.ate.value->stats.rmse);
  EXPECT_EQ(std::get<std::int64_t>(back->config[0].value), 8);
  EXPECT_EQ(std::get<double>(back->config[1].value), 1.0);
  EXPECT_FALSE(back->metrics.rpe_second.value.has_value());
  EXPECT_EQ(back->recording.notes, sample_record().recording.notes);
  EXPECT_EQ(back->recording.truth, kPseudoTruthWord);
  EXPECT_EQ(back->recording.start_ns, sample_record().recording.start_ns);
  EXPECT_EQ(back->recording.whole_frames, 700U);
  EXPECT_EQ(back->metrics.rpe_second.reason, "shorter than 1 s");
}

TEST(Record, RejectsAStartThatNoStampCanBeCountedFrom) {
  json record = json::parse(to_json(sample_record()));
  record["recording"]["start_ns"] = std::numeric_limits<std::int64_t>::min();
  const auto refused = parse_record(record.dump(), "record.json");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("recording.start_ns"), std::string::npos) << refused.error().message;
  record["recording"].erase("start_ns");
  EXPECT_FALSE(parse_record(record.dump(), "record.json")->recording.start_ns) << "an older record has none";
}

TEST(Record, HasTheKeysThatReadersRelyOn) {
  const json record = json::parse(to_json(sample_record()));
  for (const char* const path : {"/schema",
                                 "/status",
                                 "/reason",
                                 "/recording/name",
                                 "/recording/format",
                                 "/recording/frames",
                                 "/recording/duration_s",
                                 "/recording/fingerprint",
                                 "/recording/imu",
                                 "/recording/imu_note",
                                 "/recording/truth",
                                 "/recording/notes/1",
                                 "/variant",
                                 "/config",
                                 "/config_hash",
                                 "/metrics/ate/protocol",
                                 "/metrics/ate/pairs",
                                 "/metrics/ate/coverage",
                                 "/metrics/ate/alignment/matrix/15",
                                 "/metrics/ate/stats/rmse",
                                 "/metrics/ate/stats/mean",
                                 "/metrics/ate/stats/median",
                                 "/metrics/ate/stats/std",
                                 "/metrics/ate/stats/min",
                                 "/metrics/ate/stats/max",
                                 "/metrics/rpe/frame/translation/stats/rmse",
                                 "/metrics/rpe/frame/rotation/stats/rmse",
                                 "/metrics/aie/protocol",
                                 "/metrics/aie/stats/mean",
                                 "/metrics/aie/pixels",
                                 "/metrics/mesh/protocol",
                                 "/metrics/mesh/unit",
                                 "/metrics/mesh/samples/truth/seed",
                                 "/metrics/mesh/observed/share",
                                 "/metrics/mesh/alignment/matrix/15",
                                 "/metrics/mesh/accuracy/rmse",
                                 "/metrics/mesh/accuracy/p95",
                                 "/metrics/mesh/completeness",
                                 "/metrics/mesh/thresholds/0/fscore",
                                 "/metrics/mesh/first_camera/chamfer_m",
                                 "/metrics/mesh/positions",
                                 "/metrics/nees/protocol",
                                 "/metrics/nees/position/dof",
                                 "/metrics/nees/position/frames",
                                 "/metrics/nees/position/mean",
                                 "/metrics/nees/position/median",
                                 "/metrics/nees/position/max",
                                 "/metrics/nees/position/final",
                                 "/metrics/nees/position/final_bounds_95/1",
                                 "/metrics/nees/pose/reason",
                                 "/metrics/residuals/chi2_photometric",
                                 "/metrics/residuals/accepted_share",
                                 "/metrics/coverage/tracked",
                                 "/frames/total",
                                 "/frames/tracked",
                                 "/frames/lost",
                                 "/timing/wall_s",
                                 "/timing/cpu_s",
                                 "/timing/peak_rss_bytes",
                                 "/timing/fps",
                                 "/timing/stages_ms/update",
                                 "/provenance/version",
                                 "/provenance/git",
                                 "/provenance/compiler",
                                 "/provenance/flags",
                                 "/provenance/cpu",
                                 "/provenance/threads",
                                 "/provenance/host"}) {
    EXPECT_TRUE(record.contains(json::json_pointer(path))) << path;
  }
  EXPECT_EQ(record.at("/config/iekf.max_iterations/origin"_json_pointer), "--set");
}

TEST(Record, OlderRecordsAreStillRead) {
  json record = json::parse(to_json(sample_record()));
  record["metrics"].erase("mesh");
  record["metrics"].erase("nees");
  record["metrics"].erase("residuals");
  record["recording"].erase("truth");
  const auto back = parse_record(record.dump(), "record.json");
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_EQ(back->metrics.nees[1].reason, "the record is older than this metric");
  EXPECT_EQ(back->metrics.mesh.reason, "the record is older than this metric");
  EXPECT_EQ(back->metrics.residuals.reason, "the record is older than this metric");
  EXPECT_EQ(back->metrics.ate.value->pairs, 239U);
  EXPECT_EQ(back->recording.truth, "");  // nobody knows
}

TEST(Record, AProfileComesBack) {
  RunRecord record = sample_record();
  EXPECT_EQ(to_json(record).find("histogram_ms"), std::string::npos);
  record.timing.histograms = {{"update", histogram_of({3, 4, 4.5, 20})},
                              {"frame", histogram_of({1.0 / 3.0})}};
  const std::string text = to_json(record);
  for (const char* const path : {"/timing/histogram_ms/update/count", "/timing/histogram_ms/update/min",
                                 "/timing/histogram_ms/update/median", "/timing/histogram_ms/update/p90",
                                 "/timing/histogram_ms/update/p99", "/timing/histogram_ms/update/max",
                                 "/timing/histogram_ms/update/edges/1",
                                 "/timing/histogram_ms/update/counts/0", "/timing/histogram_ms/frame"}) {
    EXPECT_TRUE(json::parse(text).contains(json::json_pointer(path))) << path;
  }
  const auto back = parse_record(text, "record.json");
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_EQ(to_json(*back), text);
  EXPECT_EQ(back->timing.histograms[0].second.counts, record.timing.histograms[0].second.counts);
  json broken = json::parse(text);
  broken["timing"]["histogram_ms"]["update"].erase("p90");
  EXPECT_EQ(parse_record(broken.dump(), "record.json").error().code, ErrorCode::data_corrupt);
}

TEST(Record, NumbersThatDoNotExistAreNull) {
  const std::string text = to_json(sample_record());
  const json record = json::parse(text);
  EXPECT_TRUE(record.at("/metrics/aie/accepted/aie"_json_pointer).is_null());
  EXPECT_TRUE(record.at("/metrics/rpe/second/stats"_json_pointer).is_null());
  EXPECT_EQ(text.find(": nan"), std::string::npos);
}

TEST(Record, WithoutLoopsTheirErrorsAreNull) {
  RunRecord record = sample_record();
  record.loops->value = loop_error::LoopError{};
  const std::string text = to_json(record);
  for (const char* const key :
       {"median_translation_m", "median_rotation_rad", "nees_rotation", "nees_position"})
    EXPECT_TRUE(json::parse(text).at("loops").at("error").at(key).is_null()) << key;
  const auto back = parse_record(text, "record.json");
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_EQ(to_json(*back), text);
}

TEST(Record, StartsAsAFailure) {
  const json record = json::parse(to_json(RunRecord{}));
  EXPECT_EQ(record.at("status"), "failed");
  EXPECT_EQ(record.at("reason"), "not run");
  EXPECT_TRUE(record.at("/metrics/ate/stats"_json_pointer).is_null());
  EXPECT_TRUE(parse_record(to_json(RunRecord{}), "record.json").has_value());
}

TEST(Record, DamageIsNamed) {
  const auto message_of = [](const std::string& text) {
    const auto result = parse_record(text, "a/record.json");
    EXPECT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, ErrorCode::data_corrupt);
    EXPECT_TRUE(result.error().message.starts_with("a/record.json: ")) << result.error().message;
    return result.error().message;
  };
  json record = json::parse(to_json(sample_record()));
  message_of("");
  message_of("[]");
  message_of(record.dump().substr(0, 500));
  json without = record;
  without.erase("status");
  EXPECT_NE(message_of(without.dump()).find("status"), std::string::npos);
  json other_type = record;
  other_type["frames"]["total"] = "many";
  message_of(other_type.dump());
  json other_schema = record;
  other_schema["schema"] = 99;
  const auto of_another_version = parse_record(other_schema.dump(), "record.json");
  ASSERT_FALSE(of_another_version.has_value());
  EXPECT_EQ(of_another_version.error().code, ErrorCode::configuration);
  EXPECT_EQ(of_another_version.error().message, "record.json: schema = 99 (this program reads 1)");
}

TEST(Record, DamageOfTheTextIsToldByItsPlace) {
  const std::string whole = to_json(sample_record());
  const auto message_of = [](const std::string& text) { return parse_record(text, "r").error().message; };
  EXPECT_EQ(message_of(""), "r: empty");
  EXPECT_EQ(message_of(whole.substr(0, 400)), "r: not JSON at byte 400, where it ends");
  const std::string zeroed = whole.substr(0, 400) + std::string(whole.size() - 400, '\0');
  EXPECT_EQ(message_of(zeroed), "r: not JSON at byte 401 (zeros after a power cut?)");
  EXPECT_EQ(message_of("{}"), "r: key 'schema' not found");
}

TEST(Record, FilesStandWithTheirSizesAndHashes) {
  RunRecord record = sample_record();
  record.files = {{"images/1.png", 12, "0f"}, {"mesh.ply", 1ULL << 40U, "ff"}};
  record.timing.files = {{"frames.csv", 7, "aa"}};
  const std::string text = to_json(record);
  const json document = json::parse(text);
  EXPECT_EQ(document.at("files").at("mesh.ply").at("bytes"), 1ULL << 40U);
  EXPECT_EQ(document.at("timing").at("files").at("frames.csv").at("xxh3"), "aa");
  const auto back = parse_record(text, "record.json");
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_EQ(back->files, record.files);
  EXPECT_EQ(back->timing.files, record.timing.files);
  json older = document;
  older.erase("files");
  older["timing"].erase("files");
  EXPECT_TRUE(parse_record(older.dump(), "record.json")->files.empty());
}

TEST(Record, TheReferenceClockSurvives) {
  RunRecord record = sample_record();
  const reference_clock::ReferenceClock clock = {
      {0.1 / 3, 0.002, 1234}, true, {0.052, 0.03, 0.04, 540}, {0.041, 0.02, std::nullopt, 12}};
  record.metrics.reference_clock = {clock, {}};
  const std::string text = to_json(record);
  const json written = json::parse(text).at("metrics").at("reference_clock");
  EXPECT_EQ(written.at("applied"), "fitted");
  EXPECT_EQ(written.at("significant"), true);
  EXPECT_TRUE(written.at("fitted").at("rpe_1s_rad").is_null());
  const auto back = parse_record(text, "record.json");
  ASSERT_TRUE(back.has_value()) << back.error().message;
  const auto& read = back->metrics.reference_clock.value;
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->offset.offset_s, clock.offset.offset_s);
  EXPECT_EQ(read->offset.sigma_s, clock.offset.sigma_s);
  EXPECT_EQ(read->offset.motions, clock.offset.motions);
  EXPECT_TRUE(read->applied);
  EXPECT_EQ(read->as_read.ate_rmse_m, clock.as_read.ate_rmse_m);
  EXPECT_EQ(read->as_read.silent, clock.as_read.silent);
  EXPECT_FALSE(read->fitted.rpe_1s_rad);
  EXPECT_EQ(read->fitted.rpe_1s_m, clock.fitted.rpe_1s_m);
  json older = json::parse(text);
  older["metrics"].erase("reference_clock");
  EXPECT_FALSE(parse_record(older.dump(), "record.json")->metrics.reference_clock.value);
}

testing::JsonSchema record_schema() {
  std::ifstream file(testing::repository_root() / "docs" / "record.schema.json");
  return testing::JsonSchema(json::parse(file));
}

TEST(RecordSchema, KnowsEveryFieldAndNoOther) {
  testing::JsonSchema schema = record_schema();
  RunRecord without_loops = sample_record();
  without_loops.loops = Outcome<loop_error::LoopError>{std::nullopt, "no truth"};
  for (const RunRecord& record : {sample_record(), complete_record(), without_loops, RunRecord{}})
    EXPECT_EQ(schema.violations(json::parse(to_json(record))), std::vector<std::string>());
  EXPECT_EQ(schema.unused_properties(), std::vector<std::string>());
}

TEST(RecordSchema, HoldsForTheBaseline) {
  testing::JsonSchema schema = record_schema();
  std::size_t records = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(testing::repository_root() / "results" / "baseline")) {
    if (entry.path().filename() != "record.json") continue;
    std::ifstream file(entry.path());
    EXPECT_EQ(schema.violations(json::parse(file)), std::vector<std::string>()) << entry.path();
    ++records;
  }
  EXPECT_GT(records, 5U);
}

TEST(RecordSchema, FindsWhatDoesNotFit) {
  testing::JsonSchema schema = record_schema();
  const json whole = json::parse(to_json(complete_record()));
  const auto violations_with = [&](const char* pointer, const json& value) {
    json changed = whole;
    changed[json::json_pointer(pointer)] = value;
    return schema.violations(changed);
  };
  using Violations = std::vector<std::string>;
  EXPECT_EQ(violations_with("/metrics/ate/new_field", 1),
            Violations{"/metrics/ate/new_field: the schema does not know it"});
  EXPECT_EQ(violations_with("/timing/gpu_s", 1), Violations{"/timing/gpu_s: the schema does not know it"});
  EXPECT_EQ(violations_with("/status", "great").size(), 1U);
  EXPECT_EQ(violations_with("/frames/total", -1).size(), 1U);
  EXPECT_EQ(violations_with("/frames/total", "many").size(), 1U);
  EXPECT_EQ(violations_with("/metrics/ate/alignment/matrix/16", 1.0).size(), 1U);
  json without = whole;
  without["recording"].erase("fingerprint");
  EXPECT_EQ(schema.violations(without), Violations{"/recording: lacks fingerprint"});
}

TEST(Record, OfANumberThatIsNotFiniteIsThatOfAFailedRun) {
  RunRecord sound = sample_record();
  fail_if_not_finite(sound);
  EXPECT_EQ(sound.status, RunStatus::ok) << sound.reason << "; AIE of no accepted patch is none";
  EXPECT_EQ(to_json(sound), to_json(sample_record()));

  const double inf = std::numeric_limits<double>::infinity();
  for (const double wrong : {std::nan(""), inf, -inf}) {
    RunRecord record = sample_record();
    record.metrics.ate.value->stats.rmse = wrong;
    fail_if_not_finite(record);
    EXPECT_EQ(record.status, RunStatus::failed);
    EXPECT_TRUE(record.reason.starts_with("metrics.ate.")) << record.reason;
    EXPECT_NE(record.reason.find(fmt::format("rmse = {} is no finite number", wrong)), std::string::npos)
        << record.reason;
    EXPECT_FALSE(record.metrics.ate.value);
    const auto again = parse_record(to_json(record), "record.json");
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->reason, record.reason);
  }
  RunRecord scattered = sample_record();
  scattered.metrics.residuals = {metrics::ResidualSummary{}, {}};
  scattered.metrics.residuals.value->chi2_photometric = inf;
  fail_if_not_finite(scattered);
  EXPECT_TRUE(scattered.reason.starts_with("metrics.residuals.")) << scattered.reason;
}

}  // namespace
}  // namespace fusebench
