#include "eval/record/process/program_run.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "eval/record/process/child_setup.hpp"
#include "eval/record/process/nameless_file.hpp"

namespace fusebench::process {

namespace {

constexpr std::chrono::milliseconds kBetweenLooks(100);

/// Never returns; where the program cannot be started, the pipe gets errno.
[[noreturn]] void be_the_program(const std::vector<std::string>& command,
                                 const std::filesystem::path& working_folder, const ProgramLimits& limits,
                                 int output, int pipe, pid_t parent) {
  set_up_child(parent, output, limits.memory_bytes);
  std::signal(SIGPIPE, SIG_DFL);
  std::signal(SIGXFSZ, SIG_DFL);
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  if (chdir(working_folder.c_str()) == 0) execvp(arguments.front(), arguments.data());
  const int reason = errno;
  static_cast<void>(!write(pipe, &reason, sizeof(reason)));
  _exit(127);
}

std::string how_of(int status) {
  if (!WIFSIGNALED(status)) return fmt::format("exit code {}", WEXITSTATUS(status));
  const char* const name = strsignal(WTERMSIG(status));
  return fmt::format("signal {} ({})", WTERMSIG(status), name == nullptr ? "unknown" : name);
}

/// A started program; killed with its group and waited for when this is destroyed.
class StartedProgram {
 public:
  explicit StartedProgram(pid_t process) : process_(process) {}
  StartedProgram(const StartedProgram&) = delete;
  StartedProgram& operator=(const StartedProgram&) = delete;
  ~StartedProgram() {
    kill_group();
    rusage ignored{};
    while (process_ > 0 && !poll(ignored)) std::this_thread::sleep_for(kBetweenLooks / 10);
  }

  /// Whether it has ended; then its usage.
  bool poll(rusage& usage) {
    const pid_t ended = wait4(process_, &status_, WNOHANG, &usage);
    if (ended == 0 || (ended < 0 && errno == EINTR)) return false;
    kill_group();  // what it started and left behind
    process_ = -1;
    return true;
  }
  void kill_group() const {
    if (process_ > 0) ::kill(-process_, SIGKILL);
  }
  [[nodiscard]] int status() const { return status_; }

 private:
  pid_t process_;
  int status_ = 0;
};

}  // namespace

Result<ProgramEnd> run_program(const std::vector<std::string>& command,
                               const std::filesystem::path& working_folder, const ProgramLimits& limits,
                               const std::function<bool()>& go_on) {
  check(!command.empty(), "a command names its program");
  const NamelessFile output = nameless_file();
  std::array<int, 2> ends{};
  if (!output || pipe2(ends.data(), O_CLOEXEC) != 0)
    return fail(ErrorCode::io, fmt::format("{}: cannot be started: {}", command[0], std::strerror(errno)),
                "is there space in the folder for temporary files?");
  const auto begin = std::chrono::steady_clock::now();
  const pid_t parent = getpid();
  const pid_t process = fork();
  if (process == 0) be_the_program(command, working_folder, limits, fileno(output.get()), ends[1], parent);
  close(ends[1]);
  int reason = process < 0 ? errno : 0;
  if (process > 0) static_cast<void>(!read(ends[0], &reason, sizeof(reason)));
  close(ends[0]);
  if (process > 0) setpgid(process, process);  // whichever of the two comes first
  StartedProgram program(process);
  if (reason != 0)
    return fail(ErrorCode::run_failed,
                fmt::format("{}: cannot be started: {}", command[0], std::strerror(reason)),
                "is the program installed, and in PATH?");
  ProgramEnd end;
  rusage usage{};
  while (!program.poll(usage)) {
    end.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!go_on()) return fail(ErrorCode::run_failed, "stopped by the user");
    if (limits.time_s > 0 && end.wall_s > limits.time_s && end.how.empty()) {
      end.how = fmt::format("killed after {:g} s, its limit", limits.time_s);
      program.kill_group();
    }
    std::this_thread::sleep_for(kBetweenLooks);
  }
  end.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  end.succeeded = end.how.empty() && WIFEXITED(program.status()) && WEXITSTATUS(program.status()) == 0;
  if (end.how.empty()) end.how = how_of(program.status());
  end.output = end_of_file(output.get());
  end.cpu_s = cpu_seconds(usage);
  end.peak_rss_bytes = peak_bytes(usage);
  return end;
}

}  // namespace fusebench::process
