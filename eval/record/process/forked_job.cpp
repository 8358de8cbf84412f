#include "eval/record/process/forked_job.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/io/abandoned.hpp"
#include "eval/record/process/child_setup.hpp"

namespace fusebench::process {

namespace {

constexpr std::string_view kProgress = "progress";
constexpr std::string_view kError = "error";
constexpr std::string_view kFinished = "finished";

/// A field of a line.
std::string plain(std::string_view text) {
  std::string result(text);
  std::ranges::replace_if(
      result, [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return result;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find('\t', begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return fields;
}

std::size_t count_of(std::string_view text) {
  std::size_t count = 0;
  std::from_chars(text.data(), text.data() + text.size(), count);
  return count;
}

/// The child's last words where its own code found none.
void run_guarded(const std::function<void(const JobReporter& reporter)>& work, const JobReporter& reporter) {
  try {
    work(reporter);
  } catch (const std::bad_alloc&) {
    reporter.failed({ErrorCode::run_failed, "out of memory", ""});
  } catch (const std::exception& error) {
    reporter.failed({ErrorCode::internal, error.what(), "this is a bug: please report it"});
  }
}

/// Never returns. Nothing of the parent's is flushed, closed or destroyed by the child.
[[noreturn]] void be_the_child(const std::function<void(const JobReporter& reporter)>& work,
                               const JobLimits& limits, int pipe, int output, pid_t parent) {
  set_up_child(parent, output, limits.memory_bytes);
  std::signal(SIGPIPE, SIG_IGN);
  run_guarded(work, JobReporter(pipe));
  std::fflush(nullptr);
  _exit(0);
}

}  // namespace

void JobReporter::say(std::string_view line) const {
  while (!line.empty()) {
    const ssize_t written = write(pipe_, line.data(), line.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;  // nobody listens any more
    line.remove_prefix(static_cast<std::size_t>(written));
  }
}

void JobReporter::progress(std::size_t done, std::size_t total) const {
  say(fmt::format("{}\t{}\t{}\n", kProgress, done, total));
}

void JobReporter::failed(const Error& error) const {
  say(fmt::format("{}\t{}\t{}\t{}\n", kError, static_cast<int>(error.code), plain(error.message),
                  plain(error.hint)));
}

void JobReporter::finished(std::string_view text) const {
  say(fmt::format("{}\t{}\n", kFinished, plain(text)));
}

Result<ForkedJob> ForkedJob::start(const std::function<void(const JobReporter& reporter)>& work,
                                   const JobLimits& limits, const std::filesystem::path& writes_to) {
  NamelessFile output = nameless_file();
  std::array<int, 2> ends{};
  if (!output || pipe2(ends.data(), O_CLOEXEC) != 0) {
    return fail(ErrorCode::io, fmt::format("no process can be started: {}", std::strerror(errno)),
                "is there space in the folder for temporary files?");
  }
  const pid_t parent = getpid();
  const pid_t process = fork();
  if (process == 0) {
    close(ends[0]);
    be_the_child(work, limits, ends[1], fileno(output.get()), parent);
  }
  close(ends[1]);
  if (process < 0) {
    close(ends[0]);
    return fail(ErrorCode::io, fmt::format("no process can be started: {}", std::strerror(errno)),
                "fewer at a time (-j) may help");
  }
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return ForkedJob(process, ends[0], std::move(output), limits, writes_to);
}

ForkedJob::ForkedJob(ForkedJob&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      output_(std::move(other.output_)),
      limits_(other.limits_),
      writes_to_(std::move(other.writes_to_)),
      start_(other.start_),
      last_sign_(other.last_sign_),
      interrupted_(other.interrupted_),
      broken_limit_(std::move(other.broken_limit_)),
      partial_line_(std::move(other.partial_line_)),
      done_(other.done_),
      total_(other.total_),
      finished_(std::move(other.finished_)),
      error_(std::move(other.error_)) {}

ForkedJob::~ForkedJob() {
  if (process_ >= 0) {
    kill();
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    forget_process();
  }
  if (pipe_ >= 0) close(pipe_);
}

/// Of one that has been waited for.
void ForkedJob::forget_process() {
  const pid_t ended_process = std::exchange(process_, -1);
  if (!writes_to_.empty()) io::remove_abandoned_of(writes_to_, ended_process);
}

void ForkedJob::interrupt() {
  if (process_ < 0 || interrupted_) return;
  interrupted_ = true;
  ::kill(process_, SIGINT);
}

void ForkedJob::kill() {
  if (process_ >= 0) ::kill(process_, SIGKILL);
}

void ForkedJob::take(std::string_view line) {
  const auto fields = fields_of(line);
  if (fields[0] == kProgress && fields.size() == 3) {
    done_ = count_of(fields[1]);
    total_ = count_of(fields[2]);
  } else if (fields[0] == kError && fields.size() == 4) {
    error_ =
        Error{static_cast<ErrorCode>(count_of(fields[1])), std::string(fields[2]), std::string(fields[3])};
  } else if (fields[0] == kFinished && fields.size() == 2) {
    finished_ = std::string(fields[1]);
  }
}

/// False at the end of the file.
bool ForkedJob::hear() {
  std::array<char, 4096> part{};
  while (true) {
    const ssize_t count = read(pipe_, part.data(), part.size());
    if (count == 0) return false;
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    last_sign_ = Clock::now();
    partial_line_.append(part.data(), static_cast<std::size_t>(count));
    for (std::size_t end = partial_line_.find('\n'); end != std::string::npos;
         end = partial_line_.find('\n')) {
      take(std::string_view(partial_line_).substr(0, end));
      partial_line_.erase(0, end + 1);
    }
  }
}

void ForkedJob::enforce_limits() {
  if (!broken_limit_.empty()) return;
  const auto since = [](Clock::time_point time) {
    return std::chrono::duration<double>(Clock::now() - time).count();
  };
  if (limits_.time_s > 0 && since(start_) > limits_.time_s) {
    broken_limit_ = fmt::format("took longer than {:g} s (limits.time_s)", limits_.time_s);
  } else if (limits_.stall_s > 0 && since(last_sign_) > limits_.stall_s) {
    broken_limit_ = fmt::format("hung: no progress for {:g} s (limits.stall_s)", limits_.stall_s);
  }
  if (!broken_limit_.empty()) kill();
}

std::optional<JobEnd> ForkedJob::poll() {
  check(process_ >= 0, "a process that ended is not polled again");
  const bool open = hear();
  if (open) enforce_limits();
  int status = 0;
  rusage usage{};
  const pid_t ended_process = wait4(process_, &status, WNOHANG, &usage);
  if (ended_process == 0 || (ended_process < 0 && errno == EINTR)) return std::nullopt;
  static_cast<void>(hear());  // what came between
  forget_process();
  return ended(status, usage);
}

std::string ForkedJob::reason_of(int status) const {
  std::string where = total_ > 0 ? fmt::format(" after frame {} of {}", done_, total_) : "";
  if (!broken_limit_.empty()) return broken_limit_ + where;
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const char* const name = strsignal(signal);
    std::string text =
        fmt::format("ended by signal {} ({}){}", signal, name == nullptr ? "unknown" : name, where);
    if (signal == SIGKILL) text += ": killed from outside, perhaps for want of memory";
    return text;
  }
  return fmt::format("ended with exit code {} and no result{}", WEXITSTATUS(status), where);
}

JobEnd ForkedJob::ended(int status, const rusage& usage) {
  JobEnd end;
  end.wall_s = std::chrono::duration<double>(Clock::now() - start_).count();
  end.cpu_s = cpu_seconds(usage);
  end.peak_rss_bytes = peak_bytes(usage);
  end.output = end_of_file(output_.get());
  end.finished = std::move(finished_);
  end.error = std::move(error_);
  if (!end.finished && !end.error) end.reason = reason_of(status);
  const bool memory = end.error ? end.error->message == "out of memory"
                                : end.output.find("bad_alloc") != std::string::npos && !end.finished;
  if (memory && limits_.memory_bytes > 0) {
    end.error = Error{ErrorCode::run_failed,
                      fmt::format("out of memory{}: the limit is {} MB (limits.memory_mb)",
                                  total_ > 0 ? fmt::format(" after frame {} of {}", done_, total_) : "",
                                  limits_.memory_bytes / 1'000'000),
                      ""};
    end.reason.clear();
  }
  return end;
}

std::uint64_t ForkedJob::resident_bytes() const {
  std::ifstream file(fmt::format("/proc/{}/statm", process_));
  std::uint64_t total_pages = 0;
  std::uint64_t resident_pages = 0;
  if (!(file >> total_pages >> resident_pages)) return 0;
  return resident_pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace fusebench::process
