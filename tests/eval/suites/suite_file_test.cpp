#include "eval/suites/suite_file.hpp"

#include <gtest/gtest.h>

#include "core/config/config_access.hpp"
#include "eval/suites/engine/local_engine.hpp"
#include "eval/suites/suite_names.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace config;
using namespace record;
using namespace run;
using namespace suites;
using namespace engine;

namespace {

/// As TOML has it; empty without such an option.
std::string value_of(const EffectiveConfig& config, std::string_view key) {
  for (const OptionRow& row : describe_options(config.values())) {
    if (row.key == key) return row.value;
  }
  return "";
}

class SuiteTest : public testing::InTemporaryFolder {
 protected:
  Result<Suite> read(const std::string& text) { return read_suite(write("suite.toml", text)); }
  void expect_error(const std::string& text, const std::string& place, const std::string& part) {
    const auto suite = read(text);
    ASSERT_FALSE(suite.has_value()) << text;
    EXPECT_EQ(suite.error().code, ErrorCode::configuration);
    EXPECT_NE(suite.error().message.find("suite.toml" + place), std::string::npos) << suite.error().message;
    EXPECT_NE(suite.error().message.find(part), std::string::npos) << suite.error().message;
  }
  void add_recording(const std::string& name) {
    write(name + "/rgb.txt", "");
    write(name + "/depth.txt", "");
  }
};

constexpr const char* kGood =
    "name = \"demo\"\nrecordings = [\"a\", \"b\"]\nvariants = [\"full\", \"dm\"]\nimu = \"synthetic\"\n"
    "[config]\niekf.max_iterations = 7\n";

TEST_F(SuiteTest, ReadsEveryKey) {
  const auto suite = read(kGood);
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  EXPECT_EQ(suite->name, "demo");
  ASSERT_EQ(suite->recordings.size(), 2U);
  EXPECT_EQ(suite->recordings[0].name, "a");
  EXPECT_EQ(suite->recordings[1].name, "b");
  EXPECT_EQ(suite->recordings[1].split, "held-out");
  EXPECT_EQ(suite->variants, (std::vector<std::string>{"full", "dm"}));
  EXPECT_EQ(suite->imu, ImuChoice::synthetic);
  const auto config = suite_config(*suite, *find_variant("dm"));
  ASSERT_TRUE(config.has_value());
  EXPECT_EQ(value_of(*config, "iekf.max_iterations"), "7");
  EXPECT_EQ(value_of(*config, "terms.deformation"), "\"rigid_square\"");
  EXPECT_TRUE(config->origin("iekf.max_iterations").ends_with("suite.toml:6"));
}

TEST_F(SuiteTest, ItsNameIsThatOfAFolder) {
  const std::vector<std::string> wrong = {"../x", "/tmp/x", "a/b",    "..",
                                          ".x",   "a b",    "a\\\\b", std::string(201, 'a')};
  for (const std::string& name : wrong)
    expect_error("all = true\nname = \"" + name + "\"\nvariants = [\"full\"]\n",
                 ":2: name = ", "letters, digits, _, - and .");
  for (const std::string& name : std::vector<std::string>{"x", "my-suite_2.1", std::string(200, 'a')}) {
    const auto suite = read("name = \"" + name + "\"\nall = true\nvariants = [\"full\"]\n");
    EXPECT_TRUE(suite.has_value()) << name;
  }
}

TEST_F(SuiteTest, ErrorsNameTheLine) {
  expect_error("name = \"x\"\nvariant = [\"full\"]\n", ":2", "variants");
  expect_error("name = 3\n", ":1", "text");
  expect_error("name = \"x\"\nall = true\nvariants = [\"ful\"]\n", ":3", "full");
  expect_error("name = \"x\"\nall = true\nvariants = [\"full\", \"full\"]\n", ":3", "twice");
  expect_error("name = \"x\"\nall = true\nvariants = []\n", ":3", "not empty");
  expect_error("name = \"x\"\nall = 1\nvariants = [\"full\"]\n", ":2", "true or false");
  expect_error("name = \"x\"\nall = true\nvariants = [\"full\"]\nimu = \"fake\"\n", ":4",
               "recorded | synthetic");
  expect_error("name = \"x\"\nall = true\nvariants = [\"full\"]\n[config]\niekf.max_iterations = 900\n", ":5",
               "1 .. 200");
  expect_error("name = \"x\"\nall = true\nvariants = [\"full\"]\n[config]\niekf.iterations = 9\n", ":5",
               "iekf.max_iterations");
  expect_error("name = \"x\"\nall = true\nvariants = [\"full\"]\n[confg]\n", ":4", "config");
}

TEST_F(SuiteTest, MissingKeysAreNamed) {
  expect_error("all = true\nvariants = [\"full\"]\n", "", "name");
  expect_error("name = \"x\"\nall = true\n", "", "variants");
  expect_error("name = \"x\"\nvariants = [\"full\"]\n", "", "recordings");
  expect_error("name = \"x\"\nall = true\nrecordings = [\"a\"]\nvariants = [\"full\"]\n", "", "either");
}

TEST_F(SuiteTest, RelationsAreCheckedBeforeAnyRun) {
  expect_error("name = \"x\"\nall = true\nvariants = [\"full\"]\n[config]\ndepth.min_m = 50.0\n", "",
               "depth.min_m");
}

TEST_F(SuiteTest, ExternalProgramsAreReadWhenRunsArePlanned) {
  add_recording("data/a");
  const std::string text =
      "name = \"x\"\nall = true\nvariants = [\"full\"]\nsystems = [\"not_there.toml\"]\n";
  const auto suite = read(text);
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  EXPECT_EQ(suite->systems, std::vector<std::string>{"not_there.toml"});
  BatchOptions options;
  options.data = folder_ / "data";
  const auto planned = plan_batch(*suite, options);
  ASSERT_FALSE(planned.has_value());
  EXPECT_EQ(planned.error().code, ErrorCode::data_missing);
  EXPECT_NE(planned.error().message.find("not_there.toml"), std::string::npos);
}

TEST_F(SuiteTest, AnExclusionOfAnUnknownVariantStopsThePlan) {
  add_recording("data/a");
  const auto suite = read(
      "name = \"x\"\nall = true\nvariants = [\"full\"]\n[[exclude]]\nreason = \"slow\"\nvariant = \"ful\"\n");
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  BatchOptions options;
  options.data = folder_ / "data";
  const auto planned = plan_batch(*suite, options);
  ASSERT_FALSE(planned.has_value());
  EXPECT_EQ(planned.error().code, ErrorCode::configuration);
  EXPECT_NE(planned.error().message.find("suite.toml:6"), std::string::npos) << planned.error().message;
}

TEST_F(SuiteTest, JobsAreInAFixedOrder) {
  add_recording("data/b");
  add_recording("data/a");
  const auto suite = read("name = \"x\"\nall = true\nvariants = [\"no-imu\", \"full\"]\n");
  ASSERT_TRUE(suite.has_value());
  BatchOptions options;
  options.data = folder_ / "data";
  const auto jobs = plan_batch(*suite, options);
  ASSERT_TRUE(jobs.has_value()) << jobs.error().message;
  std::vector<std::string> order;
  for (const BatchJob& job : jobs->jobs)
    order.push_back(job.recording.filename().string() + " " + job.variant);
  EXPECT_EQ(order, (std::vector<std::string>{"a no-imu", "a full", "b no-imu", "b full"}));
}

TEST_F(SuiteTest, WithoutConfigsItIsSaidWhereTheyWereLookedFor) {
  const auto none = suite_files({});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::data_missing);
  EXPECT_NE(none.error().message.find(std::filesystem::current_path().string()), std::string::npos)
      << none.error().message;
  EXPECT_NE(none.error().hint.find("--configs"), std::string::npos);
}

TEST_F(SuiteTest, RecordingsWithASourceMayBeAbsent) {
  add_recording("a");
  const std::string head = "name = \"x\"\nvariants = [\"full\"]\n";
  const std::string absent = "[[recordings]]\nname = \"b_*\"\nsource = \"https://example.org/b\"\n";
  const auto suite = read(head + "[[recordings]]\nname = \"a\"\n" + absent);
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  BatchOptions options;
  options.data = folder_;
  const auto plan = plan_batch(*suite, options);
  ASSERT_TRUE(plan.has_value()) << plan.error().message;
  ASSERT_EQ(plan->jobs.size(), 1U);
  EXPECT_EQ(plan->jobs[0].recording.filename(), "a");
  EXPECT_EQ(plan->absent, std::vector<std::string>{"b_*: https://example.org/b"});

  const auto empty = plan_batch(*read(head + absent), options);
  ASSERT_FALSE(empty.has_value());
  EXPECT_EQ(empty.error().code, ErrorCode::data_missing);
  EXPECT_NE(empty.error().hint.find("https://example.org/b"), std::string::npos) << empty.error().hint;
}

TEST_F(SuiteTest, OnlyFiltersJobs) {
  add_recording("data/fr1_rpy");
  add_recording("data/fr1_xyz");
  const auto suite = read("name = \"x\"\nall = true\nvariants = [\"full\", \"dm\"]\n");
  BatchOptions options;
  options.data = folder_ / "data";
  options.only = {"recording=rpy", "variant=dm"};
  const auto jobs = plan_batch(*suite, options);
  ASSERT_TRUE(jobs.has_value());
  ASSERT_EQ(jobs->jobs.size(), 1U);
  EXPECT_EQ(jobs->jobs[0].variant, "dm");
  options.only = {"variant=nothing"};
  EXPECT_EQ(plan_batch(*suite, options).error().code, ErrorCode::usage);
  options.only = {"frame=3"};
  EXPECT_EQ(plan_batch(*suite, options).error().code, ErrorCode::usage);
  options.only = {};
  options.sets = {"iekf.max_iterations=0"};
  EXPECT_EQ(plan_batch(*suite, options).error().code, ErrorCode::configuration);
}

TEST_F(SuiteTest, EachNameOfAFilterHasToMatch) {
  add_recording("data/fr1_rpy");
  add_recording("data/fr1_xyz");
  const auto suite = read("name = \"x\"\nall = true\nvariants = [\"full\", \"dm\"]\n");
  BatchOptions options;
  options.data = folder_ / "data";
  options.only = {"recording=rpy", "recording=desk"};
  const auto refused = plan_batch(*suite, options);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::usage);
  EXPECT_NE(refused.error().message.find("recording=desk"), std::string::npos) << refused.error().message;
  EXPECT_NE(refused.error().hint.find("fr1_rpy, fr1_xyz"), std::string::npos) << refused.error().hint;
  options.only = {"recording=rpy", "recording=xyz"};
  EXPECT_EQ(plan_batch(*suite, options)->jobs.size(), 4U);
  options.only = {"variant=dm", "variant=direct"};
  EXPECT_EQ(plan_batch(*suite, options).error().code, ErrorCode::usage);
}

TEST_F(SuiteTest, AFilterThatOthersLeaveNothingOfIsAWarning) {
  add_recording("a");
  add_recording("b");
  const auto suite = read(
      "name = \"x\"\nvariants = [\"full\"]\n[[recordings]]\nname = \"a\"\n"
      "[[recordings]]\nname = \"b\"\nsplit = \"tuning\"\n");
  ASSERT_TRUE(suite.has_value()) << suite.error().message;
  BatchOptions options;
  options.data = folder_;
  options.only = {"recording=a", "recording=b", "split=tuning"};
  const auto plan = plan_batch(*suite, options);
  ASSERT_TRUE(plan.has_value()) << plan.error().message;
  ASSERT_EQ(plan->jobs.size(), 1U);
  ASSERT_EQ(plan->warnings.size(), 1U);
  EXPECT_NE(plan->warnings[0].find("recording=a"), std::string::npos) << plan->warnings[0];
}

TEST_F(SuiteTest, AMistypedFilterIsSaidBeforeAMissingRecording) {
  const auto suite = read("name = \"x\"\nrecordings = [\"nowhere\"]\nvariants = [\"full\", \"dm\"]\n");
  BatchOptions options;
  options.data = folder_;
  EXPECT_EQ(plan_batch(*suite, options).error().code, ErrorCode::data_missing);
  for (const char* const only : {"varient=full", "variant=fll", "split=both", "recording=elsewhere"}) {
    options.only = {only};
    EXPECT_EQ(plan_batch(*suite, options).error().code, ErrorCode::usage) << only;
  }
}

TEST_F(SuiteTest, ABrokenRecordingIsAnOutcomeAndARecord) {
  write("data/freiburg1_broken/rgb.txt", "not a list\n");
  write("data/freiburg1_broken/depth.txt", "");
  const auto suite = read("name = \"x\"\nall = true\nvariants = [\"full\", \"dm\"]\nimu = \"synthetic\"\n");
  BatchOptions options;
  options.data = folder_ / "data";
  options.out = folder_ / "out";
  const auto jobs = plan_batch(*suite, options);
  ASSERT_TRUE(jobs.has_value());
  const auto outcomes = run_locally(jobs->jobs, {});
  ASSERT_TRUE(outcomes.has_value());
  ASSERT_EQ(outcomes->size(), 2U);
  for (const BatchOutcome& outcome : *outcomes) {
    EXPECT_EQ(outcome.status, RunStatus::failed);
    EXPECT_TRUE(outcome.folder.filename().string().starts_with("not-started-")) << outcome.folder;
    const auto record = read_record(outcome.folder / "record.json");
    ASSERT_TRUE(record.has_value()) << record.error().message;
    EXPECT_EQ(record->reason, outcome.reason);
    EXPECT_FALSE(record->reason.empty());
  }
}

TEST_F(SuiteTest, OfAllOnlyWhatCanBeOpenedIsARow) {
  // A folder that tells no camera is not this suite's business, one that names it is.
  write("data/unknown_camera/rgb.txt", "1.0 rgb/1.png\n");
  write("data/unknown_camera/depth.txt", "1.0 depth/1.png\n");
  BatchOptions options;
  options.data = folder_ / "data";
  options.out = folder_ / "out";
  for (const auto& [text, skipped] :
       {std::pair("all = true", true), std::pair("recordings = [\"unknown_camera\"]", false)}) {
    const auto suite = read(std::string("name = \"x\"\nvariants = [\"no-imu\"]\n") + text + "\n");
    ASSERT_TRUE(suite.has_value());
    const auto jobs = plan_batch(*suite, options);
    ASSERT_TRUE(jobs.has_value());
    const auto outcomes = run_locally(jobs->jobs, {});
    ASSERT_TRUE(outcomes.has_value());
    EXPECT_EQ(outcomes->front().skipped, skipped) << outcomes->front().reason;
    EXPECT_EQ(std::filesystem::exists(folder_ / "out"), !skipped);
  }
}

}  // namespace
}  // namespace fusebench
