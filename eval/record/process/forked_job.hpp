// A piece of work in a process of its own, forked from this one: what the program has loaded and opened costs
// nothing again, and a crash, a kill, a hang or too much memory takes nothing else with it.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.hpp"
#include "eval/record/process/nameless_file.hpp"

struct rusage;

namespace fusebench::process {

/// What a process may use; 0: no limit.
struct JobLimits {
  double time_s = 0;               ///< from start to end
  double stall_s = 0;              ///< without a sign of progress
  std::uint64_t memory_bytes = 0;  ///< of its own data; what it shares with this process counts as well
};

/// How the work tells what it does, from within its process.
class JobReporter {
 public:
  explicit JobReporter(int pipe) : pipe_(pipe) {}
  void progress(std::size_t done, std::size_t total) const;
  void failed(const Error& error) const;       ///< the last word
  void finished(std::string_view text) const;  ///< the last word

 private:
  void say(std::string_view line) const;
  int pipe_;
};

/// How it ended.
struct JobEnd {
  std::optional<std::string> finished;  ///< what finished() was told
  std::optional<Error> error;           ///< what failed() was told
  std::string reason;  ///< if neither: "signal 11 (Segmentation fault) after frame 117 of 240"; else empty
  std::string output;  ///< the end of what it printed, standard error and output together
  double cpu_s = 0;    ///< user and system, by the system's accounting
  double wall_s = 0;
  std::uint64_t peak_rss_bytes = 0;
};

/// One running process. It is killed and waited for when it is destroyed.
class ForkedJob {
 public:
  /// Runs `work` in a child. This process must have a single thread then: a fork takes no other with it. The
  /// child dies with this process. Where it `writes_to` a staged folder or file, what is left of that when it
  /// has been killed or has crashed is removed. Error io.
  [[nodiscard]] static Result<ForkedJob> start(const std::function<void(const JobReporter& reporter)>& work,
                                               const JobLimits& limits,
                                               const std::filesystem::path& writes_to = {});

  ForkedJob(ForkedJob&& other) noexcept;
  ForkedJob& operator=(ForkedJob&&) = delete;
  ~ForkedJob();

  /// For poll(2): readable when there is something to hear; at the end of file the process has ended.
  [[nodiscard]] int descriptor() const { return pipe_; }
  /// Hears what there is, and kills what has passed a limit. Nothing while it runs; afterwards its end, once.
  [[nodiscard]] std::optional<JobEnd> poll();
  void interrupt();  ///< SIGINT, once: it stops cleanly
  void kill();       ///< SIGKILL

  [[nodiscard]] std::size_t done() const { return done_; }
  [[nodiscard]] std::size_t total() const { return total_; }
  [[nodiscard]] std::uint64_t resident_bytes() const;  ///< at this moment; 0 if nobody can know

 private:
  using Clock = std::chrono::steady_clock;
  ForkedJob(pid_t process, int pipe, NamelessFile output, const JobLimits& limits,
            std::filesystem::path writes_to)
      : process_(process),
        pipe_(pipe),
        output_(std::move(output)),
        limits_(limits),
        writes_to_(std::move(writes_to)) {}
  void forget_process();
  bool hear();
  void take(std::string_view line);
  void enforce_limits();
  [[nodiscard]] JobEnd ended(int status, const rusage& usage);
  [[nodiscard]] std::string reason_of(int status) const;

  pid_t process_ = -1;  // -1: ended
  int pipe_ = -1;
  NamelessFile output_;
  JobLimits limits_;
  std::filesystem::path writes_to_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_sign_ = start_;
  bool interrupted_ = false;
  std::string broken_limit_;  // why it was killed
  std::string partial_line_;  // of a line that is not complete
  std::size_t done_ = 0;
  std::size_t total_ = 0;
  std::optional<std::string> finished_;
  std::optional<Error> error_;
};

}  // namespace fusebench::process
