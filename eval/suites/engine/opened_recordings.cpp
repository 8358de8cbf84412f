#include "eval/suites/engine/opened_recordings.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <fstream>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include "datasets/open_recording.hpp"
#include "eval/record/process/forked_job.hpp"
#include "eval/record/process/machine_memory.hpp"

namespace fusebench::engine {

namespace {

/// Bytes that this process has read so far; 0 if nobody can know.
std::uint64_t bytes_read() {
  std::ifstream file("/proc/self/io");
  std::string name;
  std::uint64_t bytes = 0;
  return file >> name >> bytes && name == "rchar:" ? bytes : 0;
}

/// A limit on memory that leaves what the machine has, beside what this process has already; 0, for none,
/// where nobody knows.
std::uint64_t machine_limit_bytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0;
  for (int field = 0; field < 6; ++field) file >> pages;  // the last is data and stacks
  const std::uint64_t available = process::available_memory_bytes();
  constexpr std::uint64_t kUnknown = std::uint64_t{1} << 60;
  if (!file || available >= kUnknown) return 0;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + available;
}

/// Gives a sign whenever something was read.
void watch_reading(const std::stop_token& stop, const process::JobReporter& reporter) {
  constexpr std::chrono::milliseconds kWatchEvery(200);
  constexpr std::uint64_t kByLooking = 4096;  // what asking how much was read reads itself
  std::mutex mutex;
  std::condition_variable_any wait;
  std::unique_lock lock(mutex);
  std::uint64_t before = bytes_read();
  while (!wait.wait_for(lock, stop, kWatchEvery, [&] { return stop.stop_requested(); })) {
    const std::uint64_t now = bytes_read();
    if (now > before + kByLooking) reporter.progress(0, 0);
    before = now;
  }
}

/// In the child.
void work(const std::function<Result<void>()>& open, const process::JobReporter& reporter) {
  Result<void> opened;
  {
    const std::jthread watching([&](const std::stop_token& stop) { watch_reading(stop, reporter); });
    opened = open();
  }
  if (opened) {
    reporter.finished("");
  } else {
    reporter.failed(opened.error());
  }
}

}  // namespace

Result<void> try_opening(const std::function<Result<void>()>& open, const suites::RunLimits& limits,
                         const std::atomic<bool>* stop) {
  constexpr int kLookAround_ms = 100;
  const std::uint64_t memory = limits.memory_bytes > 0 ? limits.memory_bytes : machine_limit_bytes();
  auto child = process::ForkedJob::start([&](const process::JobReporter& reporter) { work(open, reporter); },
                                         {limits.time_s, limits.stall_s, memory});
  if (!child) return tl::unexpected(child.error());
  while (true) {
    pollfd descriptor{child->descriptor(), POLLIN, 0};
    ::poll(&descriptor, 1, kLookAround_ms);
    if (stop != nullptr && stop->load()) return fail(ErrorCode::run_failed, "stopped by the user");
    const auto end = child->poll();
    if (!end) continue;
    if (end->finished) return {};
    if (end->error && end->error->code != ErrorCode::run_failed) return tl::unexpected(*end->error);
    return fail(ErrorCode::run_failed,
                fmt::format("opening the recording: {}", end->error ? end->error->message : end->reason));
  }
}

void OpenedRecordings::open(const run::RunSpec& spec) {
  if (whole_ && spec.recording == recording_) return;
  views_.clear();
  recording_ = spec.recording;
  const auto open_it = [&] { return datasets::open_recording(spec.recording, spec.open); };
  if (auto tried = try_opening([&] { return open_it().map([](const auto&) {}); }, limits_, stop_); tried) {
    whole_ = open_it();
  } else {
    whole_ = tl::unexpected(tried.error());
  }
}

const Result<recording::Recording>& OpenedRecordings::of(const run::RunSpec& spec) {
  open(spec);
  if (!*whole_) return *whole_;
  std::string window = spec.frames ? run::to_string(*spec.frames) : "all";
  if (window != window_) {
    views_.clear();
    window_ = std::move(window);
  }
  const std::string key =
      fmt::format("{} {}", static_cast<int>(spec.imu), run::wants_imu(spec) ? "imu" : "no imu");
  const auto found = views_.find(key);
  if (found != views_.end()) return found->second;
  return views_.emplace(key, run::view_for_run(**whole_, spec)).first->second;
}

}  // namespace fusebench::engine
