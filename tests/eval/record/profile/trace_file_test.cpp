#include "eval/record/profile/trace_file.hpp"

#include <gtest/gtest.h>

#include "tests/support/trace_events.hpp"

namespace fusebench {

using namespace health;
using namespace profile;

namespace {

using std::chrono::microseconds;

constexpr microseconds kFrame{30'000};

/// Two frames of 30 ms; in the first one preprocess runs twice, the second one is lost and fuses nothing.
RunProfile sample_profile(bool decodes_ahead) {
  RunProfile profile;
  profile.decodes_ahead = decodes_ahead;
  for (std::size_t frame = 0; frame < 2; ++frame) {
    const auto begin = profile.start + static_cast<int>(frame + 1) * kFrame;
    const auto at = [&](int us) { return begin + microseconds(us); };
    FrameTimes times;
    times.frame = frame;
    times.status = frame == 0 ? FrameStatus::tracked : FrameStatus::lost;
    times.images = {at(0), at(4'000)};
    times.decode = decodes_ahead ? TimeSpan{at(-20'000), at(3'999)} : TimeSpan{at(10), at(3'990)};
    times.stages.add({Stage::predict, {at(4'001), at(4'101)}});
    times.stages.add({Stage::preprocess, {at(5'000), at(7'000)}});
    times.stages.add({Stage::update, {at(7'000), at(17'500)}});
    if (frame == 0) {
      times.stages.add({Stage::preprocess, {at(18'000), at(19'000)}});
      times.stages.add({Stage::fuse, {at(19'000), at(25'000)}});
    }
    times.output = {at(25'500), at(26'000)};
    profile.frames.push_back(times);
  }
  profile.mesh = {profile.start + 4 * kFrame, profile.start + 5 * kFrame};
  return profile;
}

TEST(TraceFile, EventsAreApartOrWithinOneAnother) {
  for (const bool ahead : {false, true}) {
    const auto events = testing::complete_events(trace_text(sample_profile(ahead), "t"));
    EXPECT_TRUE(testing::nest_properly(events)) << ahead;
    for (const testing::TraceEvent& event : events)
      EXPECT_EQ(event.thread, ahead && event.name == "decode" ? 2 : 1) << event.name;
  }
  // The check itself: on one thread, decoding ahead would cut through the frame before.
  auto events = testing::complete_events(trace_text(sample_profile(true), "t"));
  for (testing::TraceEvent& event : events) event.thread = 1;
  EXPECT_FALSE(testing::nest_properly(events));
}

TEST(TraceFile, TimesOfAFrameAddUp) {
  const RunProfile profile = sample_profile(false);
  const auto events = testing::complete_events(trace_text(profile, "t"));
  for (const FrameTimes& times : profile.frames) {
    const int frame = static_cast<int>(times.frame);
    for (std::size_t stage = 0; stage < kStageNames.size(); ++stage) {
      EXPECT_NEAR(testing::time_in_frame_ms(events, std::string(kStageNames[stage]), frame),
                  times.stages.sums_ms()[stage], 1e-9);
    }
    EXPECT_NEAR(testing::time_in_frame_ms(events, "frame", frame), 26, 1e-9);
    EXPECT_NEAR(testing::time_in_frame_ms(events, "decode", frame), 3.98, 1e-9);
  }
  EXPECT_EQ(events.front().name, "frame");
  EXPECT_EQ(events.front().begin_ns, 30'000'000);  // since the run began
  EXPECT_EQ(events.front().args.at("status"), "tracked");
  EXPECT_EQ(events.back().name, "mesh_once");
}

TEST(TraceFile, ProcessAndThreadsHaveNames) {
  const auto names = [](bool ahead) {
    std::vector<std::string> found;
    const auto trace =
        nlohmann::json::parse(trace_text(sample_profile(ahead), "fusebench \"a\\b\xff\" full"));
    for (const auto& event : trace.at("traceEvents")) {
      if (event.at("ph") == "M") found.push_back(event.at("args").at("name"));
    }
    return found;
  };
  const std::string title =
      "fusebench \"a\\b\xEF\xBF\xBD\" full";  // what is no UTF-8 does not break the file
  EXPECT_EQ(names(false), (std::vector<std::string>{title, "frames"}));
  EXPECT_EQ(names(true), (std::vector<std::string>{title, "frames", "decoding ahead"}));
}

TEST(TraceFile, ARunWithoutFramesIsATraceAsWell) {
  RunProfile profile;
  profile.mesh = {profile.start, profile.start};
  EXPECT_EQ(testing::complete_events(trace_text(profile, "t")).size(), 1U);
}

TEST(RunProfile, HistogramsAreOfTheFramesThatHadTheStage) {
  const auto histograms = stage_histograms(sample_profile(true));
  std::vector<std::string> names;
  for (const auto& [name, histogram] : histograms) {
    names.push_back(name);
    EXPECT_EQ(histogram.count, name == "fuse" ? 1U : 2U) << name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"decode", "preprocess", "predict", "update", "fuse", "frame"}));
  EXPECT_NEAR(histograms[1].second.max_ms, 3, 1e-9);  // both stretches of preprocess
  EXPECT_NEAR(histograms[5].second.median_ms, 26, 1e-9);
  EXPECT_TRUE(stage_histograms({}).empty());
}

}  // namespace
}  // namespace fusebench
