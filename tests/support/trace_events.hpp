// The events of a trace.json, read as a viewer does.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fusebench::testing {

struct TraceEvent {
  std::string name;
  int thread = 0;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  nlohmann::json args;
};

/// The complete events in their order in the file. Fails the test that calls if the text is no trace.
inline std::vector<TraceEvent> complete_events(const std::string& text) {
  const auto document = nlohmann::json::parse(text, nullptr, false);
  EXPECT_TRUE(document.is_object() && document.contains("traceEvents"));
  std::vector<TraceEvent> events;
  if (!document.is_object()) return events;
  const auto nanoseconds = [](const nlohmann::json& microseconds) {
    return static_cast<std::int64_t>(std::llround(1e3 * microseconds.get<double>()));
  };
  for (const nlohmann::json& event : document.at("traceEvents")) {
    EXPECT_TRUE(event.at("ph") == "X" || event.at("ph") == "M") << event;
    EXPECT_EQ(event.at("pid"), 1);
    if (event.at("ph") != "X") continue;
    const std::int64_t begin_ns = nanoseconds(event.at("ts"));
    events.push_back({event.at("name"), event.at("tid"), begin_ns, begin_ns + nanoseconds(event.at("dur")),
                      event.at("args")});
  }
  return events;
}

/// Of each thread, events are apart or one within the other, and none ends before it begins.
inline bool nest_properly(std::vector<TraceEvent> events) {
  std::ranges::stable_sort(events, [](const TraceEvent& a, const TraceEvent& b) {
    return a.begin_ns != b.begin_ns ? a.begin_ns < b.begin_ns : a.end_ns > b.end_ns;
  });
  std::map<int, std::vector<std::int64_t>> open_ends_ns;
  for (const TraceEvent& event : events) {
    std::vector<std::int64_t>& open = open_ends_ns[event.thread];
    while (!open.empty() && open.back() <= event.begin_ns) open.pop_back();
    if (event.end_ns < event.begin_ns || (!open.empty() && event.end_ns > open.back())) return false;
    open.push_back(event.end_ns);
  }
  return true;
}

/// Time of the events of that name in that frame, milliseconds.
inline double time_in_frame_ms(const std::vector<TraceEvent>& events, const std::string& name, int frame) {
  std::int64_t sum_ns = 0;
  for (const TraceEvent& event : events) {
    if (event.name == name && event.args.value("frame", -1) == frame) sum_ns += event.end_ns - event.begin_ns;
  }
  return 1e-6 * static_cast<double>(sum_ns);
}

}  // namespace fusebench::testing
