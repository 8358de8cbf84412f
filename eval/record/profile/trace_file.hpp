// trace.json: a profiled run on a line of time, in the Trace Event Format that chrome://tracing and
// ui.perfetto.dev open.
//
// {"displayTimeUnit": "ms", "traceEvents": [...]}, an event a line: complete events ("ph": "X") with ts and
// dur in microseconds since the run began, and metadata events ("ph": "M") that name process and threads. The
// thread of the run has an event "frame" a frame, with its number and status in args, and within it the
// frame's images ("decode", or "wait" where decoding runs ahead), its stages and "output" (rows and pixels);
// after the last one "mesh_once". Decoding that runs ahead has a thread of its own. On one thread, events are
// apart or one within the other.
#pragma once

#include <string>

#include "eval/record/profile/run_profile.hpp"

namespace fusebench::profile {

inline constexpr const char* kTraceFile = "trace.json";

/// title: of the process, what was run. The whole file.
[[nodiscard]] std::string trace_text(const RunProfile& profile, const std::string& title);

}  // namespace fusebench::profile
