#include "eval/record/profile/trace_file.hpp"

#include <fmt/format.h>

#include <iterator>

#include "eval/text/json_text.hpp"

namespace fusebench::profile {

namespace {

// A run is one process to the reader of a trace, whatever the system called it.
constexpr int kProcess = 1;
enum class TraceThread { run = 1, decode_ahead = 2 };

/// Events as lines of a JSON array.
class TraceWriter {
 public:
  explicit TraceWriter(std::chrono::steady_clock::time_point start) : start_(start) {}

  /// kind: process_name or thread_name.
  void name(std::string_view kind, TraceThread thread, const std::string& name) {
    begin_event();
    fmt::format_to(out(), R"({{"ph":"M","pid":{},"tid":{},"name":"{}","args":{{"name":{}}}}})", kProcess,
                   static_cast<int>(thread), kind, text::json_text(name, -1));
  }

  /// args: the members of a JSON object.
  void complete(std::string_view name, TraceThread thread, const health::TimeSpan& time,
                const std::string& args) {
    begin_event();
    fmt::format_to(out(),
                   R"({{"ph":"X","pid":{},"tid":{},"name":"{}","ts":{:.3f},"dur":{:.3f},"args":{{{}}}}})",
                   kProcess, static_cast<int>(thread), name, microseconds(time.begin - start_),
                   microseconds(time.end - time.begin), args);
  }

  [[nodiscard]] std::string finish() && { return std::move(text_) + "\n]}\n"; }

 private:
  std::back_insert_iterator<std::string> out() { return std::back_inserter(text_); }

  void begin_event() {
    text_ += first_ ? "\n" : ",\n";
    first_ = false;
  }

  static double microseconds(std::chrono::steady_clock::duration duration) {
    return std::chrono::duration<double, std::micro>(duration).count();
  }

  std::chrono::steady_clock::time_point start_;
  std::string text_ = R"({"displayTimeUnit":"ms","traceEvents":[)";
  bool first_ = true;
};

void add_frame(const FrameTimes& frame, bool decodes_ahead, TraceWriter& trace) {
  const std::string number = fmt::format(R"("frame":{})", frame.frame);
  trace.complete(kFrameName, TraceThread::run, frame.frame_time(),
                 fmt::format(R"({},"status":"{}")", number, health::to_string(frame.status)));
  trace.complete("decode", decodes_ahead ? TraceThread::decode_ahead : TraceThread::run, frame.decode,
                 number);
  if (decodes_ahead) trace.complete("wait", TraceThread::run, frame.images, number);
  for (const health::StageSpan& span : frame.stages.spans()) {
    trace.complete(health::kStageNames[static_cast<std::size_t>(span.stage)], TraceThread::run, span.time,
                   number);
  }
  trace.complete("output", TraceThread::run, frame.output, number);
}

}  // namespace

std::string trace_text(const RunProfile& profile, const std::string& title) {
  TraceWriter trace(profile.start);
  trace.name("process_name", TraceThread::run, title);
  trace.name("thread_name", TraceThread::run, "frames");
  if (profile.decodes_ahead) trace.name("thread_name", TraceThread::decode_ahead, "decoding ahead");
  for (const FrameTimes& frame : profile.frames) add_frame(frame, profile.decodes_ahead, trace);
  trace.complete("mesh_once", TraceThread::run, profile.mesh, "");
  return std::move(trace).finish();
}

}  // namespace fusebench::profile
